"""A mesh's triangles side by side in one picture, for what is computed at each place of a surface: each has a patch of its
own, with a border, whose pixels are alike in size on the whole mesh."""

from collections import namedtuple

import numpy as np

from .nodes import Sheet

_TRIANGLES_MOST = 32768  # with more, each has one pixel
_PIXELS_OF_TRIANGLE = 32  # with fewer there is hardly anything within a patch's border
_INSET = 1.5  # pixels from a patch's side to its triangle
_SIDE_MOST = 4000

# What a part of a mesh says of its corners, (triangles, 3, 2 or 3): where they are, in Generated coordinates too, and by
# each uv map's name; "": the map that renders.
Corners = namedtuple("Corners", "positions generated uvs")


def _patches(corners, pixels):
    """Each triangle lies on its longest side: which corner is first, its length, where its tip stands, its height; and
    pixels for each unit of length."""
    sides = np.linalg.norm(np.roll(corners, -1, axis=1) - corners, axis=-1)
    first = sides.argmax(axis=1)
    turned = np.take_along_axis(corners, ((first[:, None] + np.arange(3)) % 3)[..., None], 1)
    base, other = turned[:, 1] - turned[:, 0], turned[:, 2] - turned[:, 0]
    length = np.maximum(np.linalg.norm(base, axis=-1), 1e-12)
    tip = (base * other).sum(axis=-1) / length
    height = np.maximum(np.sqrt(np.maximum((other ** 2).sum(axis=-1) - tip ** 2, 0)), 1e-9 * length)
    low, high = 0.0, _SIDE_MOST / length.max()
    for _ in range(40):
        middle = 0.5 * (low + high)
        taken = (np.ceil(length * middle) + 2 * _INSET) @ (np.ceil(height * middle) + 2 * _INSET)
        low, high = (middle, high) if taken < pixels else (low, middle)
    return first, length, tip, height, low


def _pack(widths, heights):
    """In rows, the highest first: where each is, and the size of all."""
    side = int(max(np.sqrt(1.1 * (widths * heights).sum()), widths.max()))
    places = np.empty((len(widths), 2), np.int64)
    x = y = row = 0
    for k in np.argsort(-heights, kind="stable"):
        if x + widths[k] > side:
            x, y, row = 0, y + row, 0
        places[k] = x, y
        x, row = x + widths[k], max(row, heights[k])
    return places, side, y + row


class Atlas(Sheet):
    """As a sheet: its values are those of the pixels that triangles meet, in one row, until they are spread. kept: of a
    material's procedural textures, which colour and relief often share."""

    def __init__(self, corners, pixels):
        self.kept = {}
        self._corners = corners
        count = len(corners.positions)
        self.is_coarse = count > _TRIANGLES_MOST
        if self.is_coarse:
            self.width = int(np.ceil(np.sqrt(count)))
            self.height = -(-count // self.width)
            self._at = np.arange(count)
            self._of = self._at
            self._shares = np.full((count, 3), 1 / 3)
            centre = np.stack([(self._at % self.width + 0.5) / self.width, (self._at // self.width + 0.5) / self.height], -1)
            self.uvs = np.repeat(centre[:, None], 3, axis=1)
        else:
            self._lay_out(max(pixels, _PIXELS_OF_TRIANGLE * count))

    def _lay_out(self, pixels):
        first, length, tip, height, scale = _patches(self._corners.positions.astype(np.float64), pixels)
        widths, heights = ((np.ceil(one * scale) + 2 * _INSET).astype(np.int64) for one in (length, height))
        places, self.width, self.height = _pack(widths, heights)
        count = widths * heights
        of = np.repeat(np.arange(len(count)), count)
        within = np.arange(count.sum()) - np.repeat(np.cumsum(count) - count, count)
        column, line = within % widths[of], within // widths[of]
        up = (line + 0.5 - _INSET) / scale / height[of]
        along = ((column + 0.5 - _INSET) / scale - tip[of] * up) / length[of]
        shares = np.stack([1 - along - up, along, up], -1)
        margin = 2.0 / scale / height[of]  # pixels beyond the sides, for what lies between pixels
        met = shares.min(axis=-1) > -margin
        self._of, shares = of[met], np.clip(shares[met], -1, 2)
        self._at = (places[self._of, 1] + line[met]) * self.width + places[self._of, 0] + column[met]
        self._shares = np.empty_like(shares)
        order = (first[:, None] + np.arange(3)) % 3
        np.put_along_axis(self._shares, order[self._of], shares, 1)
        zero = np.zeros_like(length)
        local = np.stack([np.stack([zero, zero], -1), np.stack([length, zero], -1), np.stack([tip, height], -1)], 1)
        local = (local * scale + _INSET + places[:, None]) / (self.width, self.height)
        self.uvs = np.empty_like(local)
        np.put_along_axis(self.uvs, order[..., None], local, 1)

    def coordinates(self, kind, name=""):
        """Of the pixels, (n, 3); kind: UV, GENERATED or OBJECT."""
        if kind == "UV":
            corners = self._corners.uvs.get(name)
            if corners is None:
                return np.zeros((len(self._at), 3))
            corners = np.concatenate([corners, np.zeros_like(corners[..., :1])], -1)
        else:
            corners = self._corners.generated if kind == "GENERATED" else self._corners.positions
        return np.einsum("nk,nkc->nc", self._shares, corners[self._of].astype(np.float64))

    def spread(self, values):
        """From a row of pixels to the picture; what no triangle meets has the mean."""
        mean = values.mean(axis=0)
        made = np.empty((self.width * self.height,) + values.shape[1:])
        made[:] = mean
        made[self._at] = values
        return made.reshape((self.height, self.width) + values.shape[1:])
