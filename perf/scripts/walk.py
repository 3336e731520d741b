#!/usr/bin/env python3
"""walk.py: whether pictures of a walk flicker: consecutive frames, the camera's motion taken out, against their own noise.

Use: perf/scripts/walk.py camera FRAME.exr STEP COUNT      the walk's cameras, a line of six numbers for each
     perf/scripts/walk.py flicker FRAME.exr FRAME.exr ...  a line of CSV: pixels compared, and two ratios
Frames are float EXR files with R, G, B and the layers P and variance, of the same number of samples a pixel. A pixel's
point in the frame before is found by its world position; it counts where all four pixels around that point show the
same surface. The squared difference is held against what the samples' variances predict for independent pixels: by
single pixels, and by means over 8 x 8 of them, in which noise averages out and a change of the light itself does not.
1: what changes from frame to frame is noise.
"""
import array
import math
import struct
import sys
import zlib

BLOCK = 8
SAME_SURFACE = 6.0  # over the width in pixels, of the distance to the camera


class Frame:
    """A float EXR file of scan lines, compressed by zip or not at all (openexr.com, "OpenEXR File Layout")."""

    def __init__(self, path):
        with open(path, 'rb') as file:
            self.data = file.read()
        if self.data[:4] != b'\x76\x2f\x31\x01' or self.data[5] & 0x1a:
            sys.exit(f'walk: error: {path} is no EXR file of one part in scan lines')
        self.attributes, at = {}, 8
        while self.data[at]:
            name, at = self.text(at)
            kind, at = self.text(at)
            size = struct.unpack_from('<i', self.data, at)[0]
            self.attributes[name] = (kind, self.data[at + 4:at + 4 + size])
            at += 4 + size
        left, top, right, bottom = struct.unpack('<4i', self.attributes['dataWindow'][1])
        self.width, self.height = right - left + 1, bottom - top + 1
        names = self.channel_names(path)
        self.channels = {name: array.array('f') for name in names}
        lines = {0: 1, 2: 1, 3: 16}.get(self.attributes['compression'][1][0])
        if lines is None:
            sys.exit(f'walk: error: {path} is compressed by neither zip nor nothing')
        chunks = -(-self.height // lines)
        for offset in struct.unpack_from(f'<{chunks}Q', self.data, at + 1):
            y, size = struct.unpack_from('<ii', self.data, offset)
            rows = min(lines, self.height - (y - top))
            raw = self.unpacked(self.data[offset + 8:offset + 8 + size], 4 * rows * self.width * len(names))
            for row in range(rows):
                for i, name in enumerate(names):
                    begin = 4 * self.width * (row * len(names) + i)
                    self.channels[name].frombytes(raw[begin:begin + 4 * self.width])
        del self.data

    def text(self, at):
        end = self.data.index(0, at)
        return self.data[at:end].decode(), end + 1

    def channel_names(self, path):
        names, at, packed = [], 0, self.attributes['channels'][1]
        while packed[at]:
            end = packed.index(0, at)
            names.append(packed[at:end].decode())
            if struct.unpack_from('<i', packed, end + 1)[0] != 2:
                sys.exit(f'walk: error: {path} has channels that are not float')
            at = end + 17
        return names

    @staticmethod
    def unpacked(block, size):
        if len(block) == size:
            return block
        coded = bytearray(zlib.decompress(block))
        for i in range(1, size):
            coded[i] = (coded[i - 1] + coded[i] - 128) & 255
        out = bytearray(size)
        half = (size + 1) // 2
        out[0::2], out[1::2] = coded[:half], coded[half:]
        return bytes(out)

    def matrix(self, name):
        return struct.unpack('<16f', self.attributes[name][1])

    def samples(self):
        return int(self.attributes['afterglow/samplesPerPixel'][1])


def transformed(matrix, point):
    """A row vector times the matrix, as OpenEXR's standard attributes have it."""
    x, y, z = point
    return [x * matrix[i] + y * matrix[4 + i] + z * matrix[8 + i] + matrix[12 + i] for i in range(4)]


def luminance(frame, prefix, pixel):
    channels = frame.channels
    return (0.2126 * channels[prefix + 'R'][pixel] + 0.7152 * channels[prefix + 'G'][pixel] +
            0.0722 * channels[prefix + 'B'][pixel])


def variance(frame, pixel):
    """Of the luminance of the pixel's mean. Noise is nearly the same in all channels, so that deviations add."""
    channels = frame.channels
    deviation = sum(weight * math.sqrt(max(0.0, channels['variance.' + name][pixel]))
                    for name, weight in (('R', 0.2126), ('G', 0.7152), ('B', 0.0722)))
    return deviation * deviation / frame.samples()


def position(frame, pixel):
    return [frame.channels['P.' + axis][pixel] for axis in 'XYZ']


def compare(before, now):
    """Pixels compared; the sums of squared differences and of their predictions, by pixels and by blocks."""
    to_ndc, to_camera = before.matrix('worldToNDC'), before.matrix('worldToCamera')
    blocks, count, measured, predicted = {}, 0, 0.0, 0.0
    for pixel in range(now.width * now.height):
        point = position(now, pixel)
        ndc = transformed(to_ndc, point)
        if not any(point) or not all(map(math.isfinite, point)) or ndc[3] <= 0.0:  # where nothing is seen, P is 0
            continue
        x, y = ndc[0] / ndc[3] * before.width - 0.5, ndc[1] / ndc[3] * before.height - 0.5
        column, row = math.floor(x), math.floor(y)
        if not (0 <= column < before.width - 1 and 0 <= row < before.height - 1):
            continue
        distance = math.dist(transformed(to_camera, point)[:3], (0.0, 0.0, 0.0))
        value, noise = luminance(now, '', pixel), variance(now, pixel)
        for i, weight in ((0, (1 - x + column) * (1 - y + row)), (1, (x - column) * (1 - y + row)),
                          (before.width, (1 - x + column) * (y - row)), (before.width + 1, (x - column) * (y - row))):
            neighbour = row * before.width + column + i
            if not math.dist(position(before, neighbour), point) < SAME_SURFACE / now.width * distance:
                break
            value -= weight * luminance(before, '', neighbour)
            noise += weight * weight * variance(before, neighbour)
        else:
            count += 1
            measured += value * value
            predicted += noise
            block = blocks.setdefault((pixel % now.width // BLOCK, pixel // now.width // BLOCK), [0.0, 0.0])
            block[0] += value
            block[1] += noise
    return [count, measured, predicted, sum(b[0] ** 2 for b in blocks.values()), sum(b[1] for b in blocks.values())]


def flicker(paths):
    totals, before = [0.0] * 5, Frame(paths[0])
    for path in paths[1:]:
        now = Frame(path)
        totals = [a + b for a, b in zip(totals, compare(before, now))]
        before = now
    count, measured, predicted, block_measured, block_predicted = totals
    if not predicted > 0.0:
        sys.exit('walk: error: no pixel of one frame is seen in the next, or there is no noise')
    print(f'{count:.0f},{measured / predicted:.4f},{block_measured / block_predicted:.4f}')


def cameras(path, step, count):
    """A walk to the side, with the eye on what is in the middle of the picture."""
    frame = Frame(path)
    m = frame.matrix('worldToCamera')
    axes = [[m[0], m[4], m[8]], [m[1], m[5], m[9]], [m[2], m[6], m[10]]]
    eye = [-sum(m[12 + k] * axes[k][i] for k in range(3)) for i in range(3)]
    distance = math.dist(position(frame, frame.height // 2 * frame.width + frame.width // 2), eye)
    if not math.isfinite(distance):
        sys.exit('walk: error: nothing stands in the middle of the picture')
    target = [eye[i] + axes[2][i] * distance for i in range(3)]
    for number in range(count):
        stand = [eye[i] + axes[0][i] * step * number * distance for i in range(3)]
        print(*(f'{value:.9g}' for value in stand + target))


if __name__ == '__main__':
    if len(sys.argv) == 5 and sys.argv[1] == 'camera':
        cameras(sys.argv[2], float(sys.argv[3]), int(sys.argv[4]))
    elif len(sys.argv) >= 4 and sys.argv[1] == 'flicker':
        flicker(sys.argv[2:])
    else:
        sys.exit(__doc__)
