"""The Sky Texture as a picture of all directions and a sun. Light scattered once by air and dust on its way from the sun,
dimmed by both and by ozone. The sky is meant to be the one that Cycles shows, so that the steps along a ray are its own.
Rests on: Nishita, Sirai, Tadamura, Nakamae, "Display of The Earth Taking into Account Atmospheric Scattering", 1993."""

import math

import numpy as np

from .node_math import rgb_of_spectrum

_EARTH_M, _TOP_M = 6360e3, 6420e3
_AIR_M, _DUST_M = 8000.0, 1200.0  # heights at which there is 1/e of it
_DUST_SCATTERING, _DUST_EXTINCTION, _DUST_FORWARD = 2e-5, 2.22e-5, 0.76  # 1/m, 1/m, g
_NM = np.arange(380.0, 781.0, 20.0)
# Rayleigh's formula, 1/m at sea level: an index of refraction that is the same for all waves, and molecules per m^3.
_AIR_INDEX, _AIR_MOLECULES = 1.0002926, 2.504e25
_AIR_SCATTERING = 8 * math.pi ** 3 * (_AIR_INDEX ** 2 - 1) ** 2 / (3 * _AIR_MOLECULES * (_NM * 1e-9) ** 4)
_OZONE = 5.4e-4 * np.interp(_NM, np.arange(400.0, 761.0, 20.0), (  # 1/m where it is densest; cross sections, 1e-21 cm^2
    0.01, 0.03, 0.12, 0.35, 0.68, 1.2, 1.8, 2.9, 3.9, 4.6, 5.1, 4.0, 2.9, 2.1, 1.4, 0.88, 0.5, 0.3, 0.25)) * 1e-3
_LIMB = 1 - 0.6 / 3  # the mean of a disc whose light falls off as 1 - 0.6 (1 - cos) towards its limb, as Cycles' does
_VIEW_STEPS = 32
# Towards the sun amounts fall off about exponentially: Gauss' and Laguerre's points, the last one just below the top.
_TO_SUN, _SUN_WEIGHTS = np.polynomial.laguerre.laggauss(8)
_TO_SUN, _SUN_WEIGHTS = _TO_SUN / 25, _SUN_WEIGHTS * np.exp(_TO_SUN) / 25
_WIDTH, _HEIGHT = 512, 256
_CYCLES_ROWS, _CYCLES_COLUMNS = 128, 512


def _sun_spectrum():
    """W/m^2/nm beyond the atmosphere, by a black body of 5778 K seen under 6.79e-5 sr."""
    m = _NM * 1e-9
    return 6.79e-5 * 1.191e-16 / m ** 5 / np.expm1(1.4388e-2 / (m * 5778.0)) * 1e-9


def _densities(height_m):
    ozone = np.clip(np.minimum((height_m - 10e3) / 15e3, (40e3 - height_m) / 15e3), 0, 1)
    return np.stack([np.exp(-height_m / _AIR_M), np.exp(-height_m / _DUST_M), ozone], -1)


def _length_to(radius_m, at, direction):
    """From points to a sphere about the earth's middle, along a direction; from within it."""
    along = (at * direction).sum(axis=-1)
    return -along + np.sqrt(np.maximum(along ** 2 - (at ** 2).sum(axis=-1) + radius_m ** 2, 0))


def _depths(at, direction):
    """The amounts of air, dust and ozone from points to the top, in m of their full density."""
    length = _length_to(_TOP_M, at, direction)[..., None]
    total = np.zeros((*at.shape[:-1], 3))
    for part, weight in zip(_TO_SUN, _SUN_WEIGHTS):
        height = np.linalg.norm(at + direction * length * part, axis=-1) - _EARTH_M
        total += _densities(np.maximum(height, 0)) * length * weight
    return total


def _is_lit(at, direction):
    """Whether the earth is not in the way."""
    along = (at * direction).sum(axis=-1)
    return (along > 0) | ((at ** 2).sum(axis=-1) - along ** 2 > _EARTH_M ** 2)


def _shown(elevation, azimuth):
    """Of which direction Cycles shows the sky at one; azimuths are from the sun's. Its picture of the sky has rows that
    become closer towards the horizon, by the square, and is looked up half a row too low, half a column too far from the
    sun."""
    row = np.sqrt(elevation / (math.pi / 2)) - 0.5 / _CYCLES_ROWS
    return math.pi / 2 * np.maximum(row, 0) ** 2, azimuth + math.pi / _CYCLES_COLUMNS


class Sky:
    """Of a Sky Texture node."""

    def __init__(self, node):
        self._densities = np.array([node.air_density, node.dust_density, node.ozone_density])
        self._eye = np.array([0.0, 0.0, _EARTH_M + min(max(node.altitude, 1.0), 59e3)])
        self.elevation, self.rotation, self._sun_size = node.sun_elevation, node.sun_rotation, node.sun_size
        self._sun = np.array([math.cos(self.elevation), 0.0, math.sin(self.elevation)])

    def _transmittance(self, depths, wave):
        loss = np.array([_AIR_SCATTERING[wave], _DUST_EXTINCTION, _OZONE[wave]]) * self._densities
        return np.exp(-(depths @ loss))

    def _radiance(self, directions):
        """Spectra (..., waves) of the sky, of directions above the horizon in the frame of the sun's azimuth. The light of
        a step passes the whole of it, as in Cycles, where its middle would be half of it: by the long steps at the horizon
        that is much."""
        cosine = directions @ self._sun
        g = _DUST_FORWARD
        phases = (3 / (16 * math.pi) * (1 + cosine ** 2),
                  3 / (8 * math.pi) * (1 - g * g) * (1 + cosine ** 2) / ((2 + g * g) * (1 + g * g - 2 * g * cosine) ** 1.5))
        eye = np.broadcast_to(self._eye, directions.shape)
        step = _length_to(_TOP_M, eye, directions)[..., None] / _VIEW_STEPS
        made = np.zeros((*directions.shape[:-1], len(_NM)))
        passed = np.zeros((*directions.shape[:-1], 3))
        for k in range(_VIEW_STEPS):
            point = eye + directions * step * (k + 0.5)
            here = _densities(np.maximum(np.linalg.norm(point, axis=-1) - _EARTH_M, 0))
            passed = passed + here * step
            depths = passed + _depths(point, self._sun)
            lit = _is_lit(point, self._sun) * step[..., 0]
            air, dust = (phases[n] * here[..., n] * self._densities[n] * lit for n in (0, 1))
            for wave in range(len(_NM)):
                made[..., wave] += self._transmittance(depths, wave) * (
                    air * _AIR_SCATTERING[wave] + dust * _DUST_SCATTERING)
        return made * _sun_spectrum()

    def picture(self):
        """(height, width, 3), lowest row first, as Blender's equirectangular pictures lie; below the horizon its light
        fades."""
        rows = _HEIGHT // 2
        elevations = np.append(0, (np.arange(rows) + 0.5) / rows * (math.pi / 2))  # the horizon, and the rows above it
        azimuths = (np.arange(_WIDTH // 2) + 0.5) / (_WIDTH // 2) * math.pi  # from the sun's, to one side
        up, around = _shown(elevations[:, None], azimuths)
        directions = np.stack(np.broadcast_arrays(np.cos(up) * np.cos(around), np.cos(up) * np.sin(around), np.sin(up)), -1)
        side = rgb_of_spectrum(_NM, self._radiance(directions))
        around = np.concatenate([side, side[:, ::-1]], 1)
        # Column k is at the azimuth (k + 0.5) / width turns from the sun's; pictures have x in the middle, y to the left.
        phi = (0.5 - (np.arange(_WIDTH) + 0.5) / _WIDTH) * 2 * math.pi
        turns = ((phi - self.sun_azimuth()) / (2 * math.pi)) % 1.0
        turned = around[:, np.minimum((turns * _WIDTH).astype(int), _WIDTH - 1)]
        fade = np.maximum(1 - 2.5 * np.sin(elevations[1:]), 0) ** 3
        lower = turned[:1] * fade[::-1, None, None]
        return np.maximum(np.concatenate([lower, turned[1:]]), 0).astype(np.float32)

    def sun_azimuth(self):
        """From x over y, radians."""
        return math.pi / 2 - self.rotation

    def sun_direction(self):
        azimuth = self.sun_azimuth()
        return np.array([math.cos(azimuth) * math.cos(self.elevation), math.sin(azimuth) * math.cos(self.elevation),
                         math.sin(self.elevation)])

    def sun_irradiance(self):
        """RGB, W/m^2 on what faces the sun, of its node's intensity 1: the mean of the disc's lower and upper edge. As in
        Cycles, ozone dims the sky alone."""
        light = np.zeros(3)
        if not _is_lit(self._eye, self._sun):
            return light
        for edge in (-0.5, 0.5):
            elevation = max(self.elevation + edge * self._sun_size, 0.0)
            towards = np.array([math.cos(elevation), 0.0, math.sin(elevation)])
            depths = _depths(self._eye[None], towards) * (1, 1, 0)
            spectrum = np.stack([self._transmittance(depths, wave) for wave in range(len(_NM))], -1)[0] * _sun_spectrum()
            light += 0.5 * np.maximum(rgb_of_spectrum(_NM, spectrum), 0)
        return _LIMB * light
