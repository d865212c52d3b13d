#!/usr/bin/env python3
"""Draws the pictures that scenes use: make_pictures.py FOLDER.

FOLDER then holds sky.hdr (512×256, equirectangular: a low sun over a calm sea), planet.png and
tiles.png. The same bytes every time; nothing but Python's own library is needed."""
import math
import os
import struct
import sys
import zlib


# ---- files ----
def write_png(path, rows):
    """rows: lists of (r, g, b) linear in 0…1; stored as sRGB."""
    def byte(v):
        v = min(max(v, 0), 1)
        v = 12.92 * v if v <= 0.0031308 else 1.055 * v ** (1 / 2.4) - 0.055
        return round(255 * v)

    def chunk(kind, data):
        body = kind + data
        return struct.pack(">I", len(data)) + body + struct.pack(">I", zlib.crc32(body))

    raw = b"".join(b"\0" + bytes(byte(c) for pixel in row for c in pixel) for row in rows)
    with open(path, "wb") as file:
        file.write(b"\x89PNG\r\n\x1a\n"
                   + chunk(b"IHDR", struct.pack(">IIBBBBB", len(rows[0]), len(rows), 8, 2, 0, 0, 0))
                   + chunk(b"IDAT", zlib.compress(raw, 9)) + chunk(b"IEND", b""))


def rgbe(pixel):
    largest = max(pixel)
    if largest < 1e-32:
        return (0, 0, 0, 0)
    mantissa, exponent = math.frexp(largest)
    scale = mantissa * 256 / largest
    return (*(min(255, int(c * scale)) for c in pixel), exponent + 128)


def run_lengths(line):
    """Radiance's run lengths: above 128 a run of one byte, else that many bytes as they are."""
    out, i = bytearray(), 0
    while i < len(line):
        run = 1
        while i + run < len(line) and run < 127 and line[i + run] == line[i]:
            run += 1
        if run >= 3:
            out += bytes((128 + run, line[i]))
            i += run
            continue
        j = i + 1
        while j < len(line) and j - i < 128 and not (
                j + 2 < len(line) and line[j] == line[j + 1] == line[j + 2]):
            j += 1
        out += bytes((j - i,)) + line[i:j]
        i = j
    return bytes(out)


def write_hdr(path, rows):
    with open(path, "wb") as file:
        file.write(b"#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y %d +X %d\n"
                   % (len(rows), len(rows[0])))
        for row in rows:
            file.write(struct.pack(">BBH", 2, 2, len(row)))
            for plane in zip(*map(rgbe, row)):
                file.write(run_lengths(bytes(plane)))


# ---- noise ----
def lattice(x, y, z):
    h = (x * 374761393 + y * 668265263 + z * 2147483647) & 0xFFFFFFFF
    h = ((h ^ (h >> 13)) * 1274126177) & 0xFFFFFFFF
    return ((h ^ (h >> 16)) & 0xFFFF) / 65535


def mix(a, b, t):
    return a + (b - a) * t


def smooth(lo, hi, x):
    t = min(max((x - lo) / (hi - lo), 0), 1)
    return t * t * (3 - 2 * t)


def noise(x, y, z):
    i, j, k = math.floor(x), math.floor(y), math.floor(z)
    u, v, w = (smooth(0, 1, t) for t in (x - i, y - j, z - k))
    plane = [mix(mix(lattice(i, j, k + d), lattice(i + 1, j, k + d), u),
                 mix(lattice(i, j + 1, k + d), lattice(i + 1, j + 1, k + d), u), v)
             for d in (0, 1)]
    return mix(plane[0], plane[1], w)


def fractal(x, y, z, octaves):
    total, weight = 0, 0.5
    for _ in range(octaves):
        total += weight * noise(x, y, z)
        x, y, z, weight = 2.03 * x + 17, 2.03 * y + 31, 2.03 * z + 7, weight / 2
    return total


def blend(a, b, t):
    return tuple(mix(p, q, t) for p, q in zip(a, b))


# ---- the pictures ----
SUN_AZIMUTH, SUN_ELEVATION = math.radians(-38), math.radians(13)
SUN = (math.sin(SUN_AZIMUTH) * math.cos(SUN_ELEVATION), math.sin(SUN_ELEVATION),
       -math.cos(SUN_AZIMUTH) * math.cos(SUN_ELEVATION))


def sky(x, y, z):
    """Radiance from a direction with y ≥ 0."""
    towards = x * SUN[0] + y * SUN[1] + z * SUN[2]
    glow = max(0, towards)
    horizon = blend((0.40, 0.45, 0.58), (1.25, 0.72, 0.34), glow ** 3)
    color = blend(horizon, (0.07, 0.17, 0.42), min(1, y) ** 0.45)
    color = tuple(c + g * (0.5 * glow ** 24 + 2.5 * glow ** 400)
                  for c, g in zip(color, (1.0, 0.62, 0.30)))
    height = y + 0.12
    cloud = smooth(0.46, 0.66, fractal(1.1 * x / height + 5, 0, 1.1 * z / height, 6))
    cloud *= smooth(0.02, 0.16, y)
    lit = blend((0.50, 0.45, 0.50), (1.9, 1.25, 0.78), 0.15 + 0.85 * glow ** 2)
    color = blend(color, lit, 0.85 * cloud)
    disc = smooth(math.cos(math.radians(2.4)), math.cos(math.radians(1.6)), towards)
    return blend(color, (60, 44, 26), disc)


def environment(width, height):
    rows = []
    for r in range(height):
        elevation = math.pi * (0.5 - (r + 0.5) / height)
        row = []
        for c in range(width):
            azimuth = 2 * math.pi * ((c + 0.5) / width - 0.5)
            x, y, z = (math.cos(elevation) * math.sin(azimuth), math.sin(elevation),
                       -math.cos(elevation) * math.cos(azimuth))
            if y >= 0:
                row.append(sky(x, y, z))
                continue
            # The sea: the sky again, upside down, in waves that shorten towards the horizon.
            depth = 0.02 - y
            wave = fractal(3 * x / depth, 4, 9 * z / depth, 3) - 0.45
            up = abs(y) + 0.10 * abs(wave)
            seen = tuple(min(v, 9) for v in sky(x, up, z))
            fresnel = 0.04 + 0.8 * (1 - min(1, abs(y))) ** 5
            row.append(blend((0.010, 0.045, 0.060), seen, fresnel))
        rows.append(row)
    return rows


def planet(width, height):
    rows = []
    for r in range(height):
        latitude = math.pi * (0.5 - (r + 0.5) / height)
        row = []
        for c in range(width):
            longitude = 2 * math.pi * (c + 0.5) / width
            x, y, z = (math.cos(latitude) * math.cos(longitude), math.sin(latitude),
                       math.cos(latitude) * math.sin(longitude))
            land = fractal(1.7 * x + 11, 1.7 * y + 3, 1.7 * z + 5, 6)
            if land < 0.5:
                color = blend((0.008, 0.035, 0.13), (0.03, 0.20, 0.32), smooth(0.36, 0.5, land))
            else:
                dry = smooth(0.30, 0.62, fractal(3 * x, 5 * y + 40, 3 * z, 3)) * (1 - abs(y))
                color = blend((0.06, 0.16, 0.04), (0.52, 0.36, 0.15), dry)
                color = blend(color, (0.30, 0.24, 0.20), smooth(0.60, 0.70, land))
            color = blend(color, (0.88, 0.91, 0.95), smooth(0.88, 0.96, abs(y) + 0.3 * (land - 0.5)))
            row.append(color)
        rows.append(row)
    return rows


def tiles(size):
    """One tile of a floor: a star of four petals in a ring, with a joint."""
    cream, blue, rust, joint = ((0.74, 0.67, 0.54), (0.045, 0.11, 0.19), (0.46, 0.14, 0.06),
                                (0.22, 0.20, 0.18))
    def color(x, y):
        d = math.hypot(x, y)
        if max(abs(x), abs(y)) > 0.97:
            return joint
        corner = math.hypot(1 - abs(x), 1 - abs(y))
        if corner < 0.52:
            return rust if corner < 0.34 else (cream if corner < 0.44 else blue)
        if d > 0.90:
            return cream
        if d > 0.80:
            return blue
        petal = abs(math.sin(2 * math.atan2(y, x)))
        if d < 0.12:
            return cream
        return blue if d < 0.76 * petal else (rust if d < 0.3 else cream)

    n = 4 # samples a side of a texel
    steps = [(i + 0.5) / n for i in range(n)]
    rows = []
    for r in range(size):
        row = []
        for c in range(size):
            samples = [color(2 * (c + s) / size - 1, 2 * (r + t) / size - 1)
                       for t in steps for s in steps]
            row.append(tuple(sum(channel) / len(samples) for channel in zip(*samples)))
        rows.append(row)
    return rows


def main():
    if len(sys.argv) != 2:
        sys.exit(__doc__)
    folder = sys.argv[1]
    write_hdr(os.path.join(folder, "sky.hdr"), environment(512, 256))
    write_png(os.path.join(folder, "planet.png"), planet(512, 256))
    write_png(os.path.join(folder, "tiles.png"), tiles(128))


if __name__ == "__main__":
    main()
