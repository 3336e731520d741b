"""Blender's procedural textures at points in space, as Cycles computes them: arrays (n, 3) to arrays (n,) and (n, 3)."""

import functools
import itertools

import numpy as np

NODES = {"TEX_NOISE", "TEX_CHECKER", "TEX_BRICK", "TEX_WAVE", "TEX_GRADIENT", "TEX_VORONOI", "TEX_MUSGRAVE", "TEX_MAGIC"}
_NEARLY = 0.000001  # so that faces on a whole number belong to one side
_SMALLEST = 1e-5
_POINTS_AT_ONCE = 1 << 14


def _by_slices(texture):
    """The texture of so many points at a time, so that what it needs in between does not grow with their number."""
    @functools.wraps(texture)
    def made(points, *rest):
        if len(points) <= _POINTS_AT_ONCE:
            return texture(points, *rest)
        parts = [texture(points[k:k + _POINTS_AT_ONCE], *rest) for k in range(0, len(points), _POINTS_AT_ONCE)]
        if isinstance(parts[0], tuple):
            return tuple(np.concatenate(each) for each in zip(*parts))
        return np.concatenate(parts)
    return made


def _turn(x, k):
    return (x << np.uint32(k)) | (x >> np.uint32(32 - k))


def hash_words(words):
    """Jenkins' lookup3 of one to four arrays of 32-bit words."""
    begun = np.uint32((0xdeadbeef + (len(words) << 2) + 13) & 0xffffffff)
    state = [begun + np.asarray(word, np.uint32) for word in words[:3]]
    a, b, c = state + [np.full_like(state[0], begun)] * (3 - len(state))
    if len(words) == 4:
        a -= c; a ^= _turn(c, 4); c = c + b
        b = b - a; b ^= _turn(a, 6); a = a + c
        c = c - b; c ^= _turn(b, 8); b = b + a
        a = a - c; a ^= _turn(c, 16); c = c + b
        b = b - a; b ^= _turn(a, 19); a = a + c
        c = c - b; c ^= _turn(b, 4); b = b + a
        a = a + np.asarray(words[3], np.uint32)
    c = (c ^ b) - _turn(b, 14)
    a = (a ^ c) - _turn(c, 11)
    b = (b ^ a) - _turn(a, 25)
    c = (c ^ b) - _turn(b, 16)
    a = (a ^ c) - _turn(c, 4)
    b = (b ^ a) - _turn(a, 14)
    return (c ^ b) - _turn(b, 24)


def _hash_numbers(numbers):
    """In [0, 1], of the bits of one to four arrays of floats."""
    shape = np.broadcast(*numbers).shape or (1,)
    words = [np.broadcast_to(np.asarray(number, np.float32), shape).copy().view(np.uint32) for number in numbers]
    return hash_words(words).astype(np.float64) / 0xffffffff


def _slope(word, x, y, z):
    """Perlin's gradient of that hash, times a vector."""
    h = word & np.uint32(15)
    u = np.where(h < 8, x, y)
    v = np.where(h < 4, y, np.where((h == 12) | (h == 14), x, z))
    return np.where(h & np.uint32(1), -u, u) + np.where(h & np.uint32(2), -v, v)


def _slope_flat(word, x, y):
    h = word & np.uint32(7)
    u, v = np.where(h < 4, x, y), 2 * np.where(h < 4, y, x)
    return np.where(h & np.uint32(1), -u, u) + np.where(h & np.uint32(2), -v, v)


# The gradients of all hashes, (2 or 3 axes, hashes): slopes along each axis.
_SLOPES = {3: np.array([_slope(np.arange(16, dtype=np.uint32), *axis) for axis in np.eye(3)]),
           2: np.array([_slope_flat(np.arange(8, dtype=np.uint32), *axis) for axis in np.eye(2)])}


def _around(cells, steps, made):
    """For each step what is made of the cells (dimensions, n) that are that far away: of every cell around once, where those
    are few beside the points, since each has many of them."""
    one_by_one = (made(cells + step[:, None]) for step in steps)
    if not cells.size:  # without the extremes that follow
        yield from one_by_one
        return
    low, high = cells.min(axis=1) + steps.min(axis=0), cells.max(axis=1) + steps.max(axis=0)
    sizes = high - low + 1
    if not sizes.prod() <= 0.25 * len(steps) * cells.shape[1]:  # also where they are no numbers
        yield from one_by_one
        return
    ways = np.cumprod(np.append(1, sizes[:-1]))
    all_of_them = low[:, None] + (np.arange(sizes.prod()) // ways[:, None]) % sizes[:, None]
    table, at = made(all_of_them), (ways @ (cells - low[:, None])).astype(np.int64)
    for step in steps:
        yield [column[at + int(ways @ step)] for column in table]


def _slopes(cells):
    return _SLOPES[len(cells)][:, hash_words(cells.astype(np.int64).astype(np.uint32)) & np.uint32(15 if len(cells) == 3 else 7)]


def signed_noise(points):
    """Perlin's, about in [-1, 1], of two or three dimensions: the length of the last axis."""
    dimensions = points.shape[-1]
    columns = np.ascontiguousarray(points.reshape(-1, dimensions).T)
    cells = np.floor(columns)
    part = columns - cells
    fade = part ** 3 * (part * (part * 6 - 15) + 10)
    total = np.zeros(columns.shape[1])
    corners = np.array(list(itertools.product((0.0, 1.0), repeat=dimensions)))
    for corner, slopes in zip(corners, _around(cells, corners, _slopes)):
        made = sum(slope * (one - far) for slope, one, far in zip(slopes, part, corner))
        for one, far in zip(fade, corner):
            made *= one if far else 1 - one
        total += made
    return (total * (0.9820 if dimensions == 3 else 0.6616)).reshape(points.shape[:-1])


def fractal(points, detail, roughness):
    """Octaves of noise in [0, 1], brought to the same."""
    detail = min(max(float(detail), 0.0), 15.0)
    total, weights, weight, scale = 0.0, 0.0, 1.0, 1.0
    for _ in range(int(detail) + 1):
        total = total + weight * (0.5 * signed_noise(points * scale) + 0.5)
        weights += weight
        weight *= min(max(float(roughness), 0.0), 1.0)
        scale *= 2
    rest = detail - int(detail)
    if rest == 0:
        return total / weights
    more = total + weight * (0.5 * signed_noise(points * scale) + 0.5)
    return (1 - rest) * total / weights + rest * more / (weights + weight)


def _offset(seed, dimensions):
    return np.array([100 + 100 * _hash_numbers([seed, float(k)])[0] for k in range(dimensions)])


@_by_slices
def noise(points, detail, roughness, distortion, is_color):
    dimensions = points.shape[-1]
    if distortion:
        points = points + distortion * np.stack(
            [signed_noise(points + _offset(float(k), dimensions)) for k in range(dimensions)], -1)
    value = fractal(points, detail, roughness)
    if not is_color:
        return value
    return np.stack([value] + [fractal(points + _offset(float(dimensions + k), dimensions), detail, roughness)
                               for k in (0, 1)], -1)


@_by_slices
def musgrave(points, kind, dimension, lacunarity, detail):
    detail, lacunarity = min(max(float(detail), 0.0), 15.0), max(float(lacunarity), _SMALLEST)
    fall, power = lacunarity ** -max(float(dimension), _SMALLEST), 1.0
    is_sum = kind == "FBM"
    value = np.zeros(points.shape[:-1]) if is_sum else np.ones(points.shape[:-1])
    for share in [1.0] * int(detail) + [detail - int(detail)]:
        if share:
            octave = share * power * signed_noise(points)
            value = value + octave if is_sum else value * (octave + 1)
            power, points = power * fall, points * lacunarity
    return value


@_by_slices
def checker(points):
    """Whether the first colour counts."""
    at = np.abs(np.floor((points + _NEARLY) * (1 - _NEARLY))).astype(np.int64) % 2
    return (at[..., 0] == at[..., 1]) == (at[..., 2] == 1)


@_by_slices
def wave(points, kind, direction, profile, distortion, detail, detail_scale, roughness, phase):
    points = (points + _NEARLY) * (1 - _NEARLY)
    axis = "XYZ".find(direction)
    if kind == "BANDS":
        at = 20 * points[..., axis] if axis >= 0 else 10 * points.sum(axis=-1)
    else:
        kept = [k for k in range(3) if k != axis]
        at = 20 * np.linalg.norm(points[..., kept], axis=-1)
    at = at + phase
    if distortion:
        at = at + distortion * (2 * fractal(points * detail_scale, detail, roughness) - 1)
    if profile == "SIN":
        return 0.5 + 0.5 * np.sin(at - 0.5 * np.pi)
    at = at / (2 * np.pi)
    return at - np.floor(at) if profile == "SAW" else 2 * np.abs(at - np.floor(at + 0.5))


@_by_slices
def gradient(points, kind):
    x, y, _ = (points[..., k] for k in range(3))
    if kind in ("SPHERICAL", "QUADRATIC_SPHERE"):
        made = np.maximum(0.999999 - np.linalg.norm(points, axis=-1), 0)
        return made if kind == "SPHERICAL" else made * made
    if kind == "EASING":
        x = np.clip(x, 0, 1)
        return x * x * (3 - 2 * x)
    made = {"QUADRATIC": lambda: np.maximum(x, 0) ** 2, "DIAGONAL": lambda: 0.5 * (x + y),
            "RADIAL": lambda: np.arctan2(y, x) / (2 * np.pi) + 0.5}.get(kind, lambda: x)()
    return np.clip(made, 0, 1)


# What each further depth of a Magic texture puts in place of a coordinate: which one, of what function and with what sign,
# and the signs of x, y and z in its argument.
_MAGIC = ((1, np.cos, -1, (1, -1, 1)), (0, np.cos, 1, (1, -1, -1)), (2, np.sin, 1, (-1, -1, -1)),
          (0, np.cos, -1, (-1, 1, -1)), (1, np.sin, -1, (-1, 1, 1)), (1, np.cos, -1, (-1, 1, 1)), (0, np.cos, 1, (1, 1, 1)),
          (2, np.sin, 1, (1, 1, -1)), (0, np.cos, -1, (-1, -1, 1)), (1, np.sin, -1, (1, -1, 1)))


@_by_slices
def magic(points, depth, distortion):
    """Colours."""
    p = 5 * np.mod(points, 2 * np.pi)
    at = [np.sin(p @ (1, 1, 1)), np.cos(p @ (-1, 1, -1)), -np.cos(p @ (-1, -1, 1))]
    if depth > 0:
        at = [distortion * one for one in at]
    for axis, function, sign, signs in _MAGIC[:depth]:
        at[axis] = distortion * sign * function(sum(s * one for s, one in zip(signs, at)))
    return 0.5 - np.stack(at, -1) / (2 * distortion or 1)


def _brick_chance(number):
    n = (number + 1013) & 0x7fffffff
    n = (n >> 13) ^ n
    n = n.astype(np.uint64).astype(np.uint32)
    made = (n * (n * n * np.uint32(60493) + np.uint32(19990303)) + np.uint32(1376312589)) & np.uint32(0x7fffffff)
    return 0.5 * made / 1073741824.0


@_by_slices
def brick(points, size, smooth, bias, width, height, offset, offset_rows, squash, squash_rows):
    """How much a point is in the mortar, and how much its brick has the second colour."""
    x, y = points[..., 0], points[..., 1]
    row = np.floor(y / height).astype(np.int64)
    widths, shift = np.full(x.shape, width), np.zeros(x.shape)
    if offset_rows and squash_rows:
        widths = np.where(row % squash_rows != 0, width, width * squash)
        shift = np.where(row % offset_rows != 0, 0.0, widths * offset)
    number = np.floor((x + shift) / widths).astype(np.int64)
    across, up = x + shift - widths * number, y - height * row
    tint = np.clip(_brick_chance((row << 16) + (number & 0xffff)) + bias, 0, 1)
    near = np.minimum(np.minimum(across, up), np.minimum(widths - across, height - up))
    inside = np.clip((1 - near / max(size, 1e-12)) / smooth, 0, 1) if smooth > 0 else np.ones(x.shape)
    return np.where(near >= size, 0.0, inside * inside * (3 - 2 * inside)), tint


def _length(columns):
    return np.sqrt(sum(one * one for one in columns))


_DISTANCES = {"MANHATTAN": lambda columns: sum(np.abs(one) for one in columns),
              "CHEBYCHEV": lambda columns: functools.reduce(np.maximum, (np.abs(one) for one in columns))}


def _jitter(cells):
    """Where a cell's point is in it, of two or three dimensions."""
    return [_hash_numbers(list(cells) + ([float(k)] if k else [])) for k in range(len(cells))]


@_by_slices
def voronoi(points, feature, metric, randomness):
    """Distance, and the cell whose colour counts; feature: F1, F2 or DISTANCE_TO_EDGE."""
    dimensions = points.shape[-1]
    columns = np.ascontiguousarray(points.T)
    cells = np.floor(columns)
    part = columns - cells
    steps = np.array(list(itertools.product((-1.0, 0.0, 1.0), repeat=dimensions)))
    is_edge = feature == "DISTANCE_TO_EDGE"
    measure = _length if is_edge else _DISTANCES.get(metric, _length)
    first, second = np.full(len(points), 8.0), np.full(len(points), 8.0)
    of_first, of_second = (np.full(len(points), len(steps) // 2) for _ in range(2))  # steps
    all_away = []
    for k, (step, jitter) in enumerate(zip(steps, _around(cells, steps, _jitter))):
        away = [far + randomness * one - at for far, one, at in zip(step, jitter, part)]
        far = measure(away)
        is_first = far < first
        if feature == "F2":
            is_second = ~is_first & (far < second)
            of_second = np.where(is_first, of_first, np.where(is_second, k, of_second))
            second = np.where(is_first, first, np.where(is_second, far, second))
        of_first[is_first] = k
        first = np.where(is_first, far, first)
        if is_edge:
            all_away.append(away)
    if not is_edge:
        far, of = (second, of_second) if feature == "F2" else (first, of_first)
        return far, (cells + steps.T[:, of]).T
    nearest = np.take_along_axis(np.array(all_away), of_first[None, None], 0)[0]
    edge = np.full(len(points), 8.0)
    for away in all_away:
        between = [one - other for one, other in zip(away, nearest)]
        length = _length(between)
        distance = sum((one + other) / 2 * part for one, other, part in zip(away, nearest, between)) / np.maximum(length, 1e-12)
        edge = np.where(length > 1e-2, np.minimum(edge, distance), edge)
    return edge, (cells + steps.T[:, of_first]).T


@_by_slices
def cell_color(cell):
    axes = [cell[..., k] for k in range(cell.shape[-1])]
    return np.stack([_hash_numbers(axes + ([float(k)] if k else [])) for k in range(3)], -1)
