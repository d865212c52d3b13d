"""examples.py TEST…: the worked examples of docs/shaders.md, against their formulas computed here."""

import json
import math
import struct

from bench import SOURCE, draw, exr, run, turner, write

EXAMPLES = SOURCE / "shaders/examples"


def dot(a, b):
    return sum(x * y for x, y in zip(a, b))


def unit(a):
    length = math.sqrt(dot(a, a))
    return [x / length for x in a]


# ---- marble ----

def random_at(x, y, z):
    mask = 0xffffffff
    state = ((x & mask) * 73856093 ^ (y & mask) * 19349663 ^ (z & mask) * 83492791) & mask
    state = (state * 747796405 + 2891336453) & mask
    state = (((state >> ((state >> 28) + 4)) ^ state) * 277803737) & mask
    return (((state >> 22) ^ state) >> 8) / 16777216


def noise(p):
    corner = [math.floor(c) for c in p]
    fade = [(c - i) * (c - i) * (3 - 2 * (c - i)) for c, i in zip(p, corner)]
    total = 0
    for dx in (0, 1):
        for dy in (0, 1):
            for dz in (0, 1):
                weight = 1
                for d, f in zip((dx, dy, dz), fade):
                    weight *= f if d else 1 - f
                total += weight * random_at(corner[0] + dx, corner[1] + dy, corner[2] + dz)
    return total


def marble_of(p, scale, strength, octaves, vein, stone):
    p = [scale * c for c in p]
    turbulence = sum(0.5 ** k * abs(2 * noise([c * 2 ** k for c in p]) - 1) for k in range(octaves))
    wave = math.sqrt(0.5 + 0.5 * math.sin(p[0] + strength * turbulence))
    return [v + (s - v) * wave for v, s in zip(vein, stone)]


def linear(v):  # IEC 61966-2-1
    return v / 12.92 if v <= 0.04045 else ((v + 0.055) / 1.055) ** 2.4


def marble():
    """The layer `albedo` is Perlin's marble at the layer `position`."""
    scene = EXAMPLES / "marble.json"
    vein = [linear(int("27323c"[i:i + 2], 16) / 255) for i in (0, 2, 4)]
    for options, values in (([], (5, 1.5, 5)),
                            (["--set", "strength=3", "--set", "octaves=2"], (5, 3, 2))):
        draw(scene, "--size", "64x48", "--aov", "albedo,position", *options)
        channels = exr.read("picture.exr").channels
        near = far = 0
        for i in range(64 * 48):
            p = [channels[f"position.{c}"][i] for c in "XYZ"]
            albedo = [channels[f"albedo.{c}"][i] for c in "RGB"]
            table = [struct.unpack("f", struct.pack("f", v))[0] for v in (0.32, 0.25, 0.2)]
            if albedo in (table, [0, 0, 0]):
                continue  # or the sky
            want = marble_of(p, *values, vein, [0.8] * 3)
            # the position is rounded to 2^-24, which the finest octave magnifies 80 times and the
            # root at the middle of a vein by up to its own root
            error = max(abs(a - w) for a, w in zip(albedo, want))
            assert error < 5e-3, (p, albedo, want)
            near += error < 1e-4
            far += 1
        assert far > 500 and near > 0.95 * far, (near, far)


# ---- Blinn ----

def blinn_of(n, v, light, k_d, k_s, exponent, sharper):
    cos_light = dot(n, light)
    if cos_light <= 0:
        return [0, 0, 0]
    half = unit([a + b for a, b in zip(v, light)])
    m = sharper * exponent
    highlight = (m + 8) / (8 * math.pi) * max(0, dot(n, half)) ** m
    return [(d / math.pi + k_s * highlight) * cos_light for d in k_d]


def blinn():
    """A sphere under one light, each pixel by the formula."""
    write("scene.json", {
        "version": 1, "settings": {"size": [24, 18]}, "shaders": str(EXAMPLES / "blinn"),
        "camera": {"from": [0, 0, 5], "at": [0, 0, 0], "vfov": 20},
        "materials": {"red": {"k_d": [0.7, 0.1, 0.08], "k_s": 0.3, "exponent": 10}},
        "primitives": [{"type": "sphere", "center": [0, 0, 0], "radius": 1, "material": "red"}],
        "lights": [{"type": "point", "position": [3, 4, 6], "intensity": 90}]})
    scale = 2 * math.tan(math.radians(10)) / 18
    for options, sharper in (([], 4), (["--set", "sharper=1.5"], 1.5), (["-m", "precision=f64"], 4)):
        shown, lit = draw("scene.json", *options), 0
        for (x, y), color in shown.items():
            d = unit([(x + 0.5 - 12) * scale, -(y + 0.5 - 9) * scale, -1])
            b = 5 * d[2]  # |(0, 0, 5) + t d| = 1
            root = b * b - 24
            if root < 0.2:
                continue  # beside the sphere, or on its edge
            t = -b - math.sqrt(root)
            p = [t * d[0], t * d[1], 5 + t * d[2]]
            to_light = [l - c for l, c in zip((3, 4, 6), p)]
            irradiance = 90 / dot(to_light, to_light)
            want = [irradiance * f for f in blinn_of(p, [-c for c in d], unit(to_light),
                                                     (0.7, 0.1, 0.08), 0.3, 10, sharper)]
            # the highlight's cosine, to the power of 40, has 40 roundings and what the device's
            # pow adds to them
            assert all(abs(a - w) <= 2e-5 * max(w, 0.01) for a, w in zip(color, want)), \
                ((x, y), color, want)
            lit += want[0] > 0.1
        assert lit > 100, lit


# ---- toon ----

def toon():
    """What the hook makes of the picture without it."""
    scene = EXAMPLES / "toon.json"
    size = ["--size", "64x48"]
    plain = draw(scene, *size, "--no-scene-shaders")
    for look, steps in (("shades", 4), ("ink", 7)):
        shown = draw(scene, *size, "--set", f"look={look}", "--set", f"steps={steps}")
        levels, checked = set(), 0
        for pixel, before in plain.items():
            brightness = dot(before, (0.2126, 0.7152, 0.0722))
            if abs(brightness * steps - round(brightness * steps)) < 1e-4:
                continue  # rounding decides
            level = min((math.floor(brightness * steps) + 0.5) / steps, 1)
            want = [c * level for c in (0.95, 0.9, 0.75)] if look == "ink" else \
                [c * level / brightness for c in before]
            assert all(abs(a - w) < 1e-5 for a, w in zip(shown[pixel], want)), (pixel, want)
            levels.add(level)
            checked += 1
        assert checked > 3000 and len(levels) >= 3, (checked, levels)


def listed():
    """Their parameters are those the text tells of."""
    names = {name: [row["name"] for row in json.loads(
        turner("params", "--json", EXAMPLES / f"{name}.json").stdout)]
        for name in ("marble", "blinn", "toon")}
    assert names == {"marble": ["stone", "vein", "scale", "strength", "octaves"],
                     "blinn": ["sharper"], "toon": ["steps", "look", "paper"]}, names


run({t.__name__: t for t in (marble, blinn, toon, listed)})
