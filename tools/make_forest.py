#!/usr/bin/env python3
"""Writes scenes/instances.json, a winter forest; the same file every time.

Three firs, each a group of cones, are put many times on two hills. With --trees it is a plain with
as many firs instead, whose transforms lie beside the scene in a file for each of the three.

Examples:
  tools/make_forest.py scenes/instances.json
  tools/make_forest.py taiga.json --trees 10000000"""
import argparse
import array
import json
import math
import os
import random
import sys

# (x, z, height, radius): hills are caps of large spheres
HILLS = ((-14, -16, 3.2, 30), (16, -24, 5.5, 34), (2, -58, 9, 60))
HOUSE = (1.6, -9.0) # no trees between it and the camera

HEAD = {
    "$schema": "schema.json",
    "version": 1,
    "description": "",
    "settings": {"size": [640, 480], "spp": 4, "depth": 0},
    "camera": {"from": [0, 3.4, 15], "at": [0.6, 2.2, 0], "vfov": 34},
    "ambient": [0.15, 0.20, 0.34],
    "background": {"type": "gradient", "bottom": [1.5, 0.62, 0.26], "top": [0.02, 0.10, 0.42]},
}


def ground(x, z):
    """Height of the snow."""
    height = 0
    for hx, hz, top, radius in HILLS:
        square = radius ** 2 - (x - hx) ** 2 - (z - hz) ** 2
        if square > 0:
            height = max(height, math.sqrt(square) - radius + top)
    return height


def fir(tiers, height, spread, material):
    """A fir of the given height about the y axis: cones with snow on their upper side."""
    parts = [{"type": "cylinder", "base": [0, -0.3, 0], "apex": [0, 0.3 * height, 0],
              "radius": 0.07, "material": "bark"}]
    for i in range(tiers):
        low = height * (0.14 + 0.80 * i / tiers)
        top = min(height, low + height * 1.25 / tiers)
        radius = spread * (1 - 0.80 * i / tiers)
        parts.append({"type": "cone", "base": [0, round(low, 3), 0],
                      "base_radius": round(radius, 3), "apex": [0, round(top, 3), 0],
                      "material": material})
        middle = 0.42
        parts.append({"type": "cone", "base": [0, round(low + middle * (top - low) + 0.02, 3), 0],
                      "base_radius": round(radius * (1 - middle) * 1.04, 3),
                      "apex": [0, round(top + 0.02, 3), 0], "material": "snow"})
    return parts


def place(rng, count):
    """Where trees stand: not before the house, not in it, not in each other."""
    spots = []
    while len(spots) < count:
        z = rng.uniform(-52, 9)
        x = rng.uniform(-1, 1) * (9 + 0.55 * (15 - z))
        size = rng.uniform(0.75, 1.25)
        clearing = 2.6 + 0.05 * (15 - z)
        if abs(x - HOUSE[0] * (15 - z) / 24) < clearing and z > HOUSE[1] - 2.5:
            continue
        if math.hypot(x, z - 15) < 5.5:
            continue
        if any((x - a) ** 2 + (z - b) ** 2 < (0.62 * (size + s)) ** 2 for a, b, s in spots):
            continue
        spots.append((x, z, size))
    return spots


FIRS = {"fir": fir(4, 2.6, 0.80, "needles"), "young fir": fir(3, 1.7, 0.62, "light needles"),
        "tall fir": fir(5, 3.6, 0.85, "dark needles")}

MATERIALS = {
    "snow": {"k_a": 0.95, "k_d": [0.86, 0.87, 0.90]},
    "needles": {"k_a": [0.10, 0.22, 0.16], "k_d": [0.045, 0.13, 0.075]},
    "light needles": {"k_a": [0.13, 0.26, 0.17], "k_d": [0.075, 0.18, 0.085]},
    "dark needles": {"k_a": [0.08, 0.18, 0.15], "k_d": [0.03, 0.10, 0.07]},
    "bark": {"k_a": 0.15, "k_d": [0.16, 0.09, 0.05]},
}

SUN = {"type": "directional", "direction": [-0.9, -0.36, -0.30], "irradiance": [3.4, 2.0, 1.0]}


def write_plain(path, trees):
    """Firs on a square lattice, each moved, turned and scaled at random: as many matrices in files,
    and a scene that names them."""
    rng = random.Random(1980)
    side = math.isqrt(trees - 1) + 1
    names = [f"{os.path.splitext(path)[0]}-{name.replace(' ', '-')}.f32" for name in FIRS]
    files = [open(name, "wb") for name in names]
    for row in range(side):
        rows = [array.array("f") for _ in files]
        for column in range(min(side, trees - row * side)):
            size, turn = rng.uniform(0.75, 1.25), rng.uniform(0, 2 * math.pi)
            c, s = size * math.cos(turn), size * math.sin(turn)
            x = 2.2 * (column - side / 2 + rng.uniform(-0.4, 0.4))
            z = -2.2 * (row + rng.uniform(-0.4, 0.4))
            rows[rng.randrange(len(rows))].extend(
                (c, 0, s, x, 0, size * rng.uniform(0.9, 1.25), 0, 0, -s, 0, c, z))
        for file, matrices in zip(files, rows):
            if sys.byteorder != "little":
                matrices.byteswap()
            matrices.tofile(file)
    for file in files:
        file.close()
    scene = dict(HEAD)
    scene["description"] = f"{trees} firs, three of which are in the file."
    scene["camera"] = {"from": [0, 9, 14], "at": [0, 0, -30], "vfov": 34}
    scene["materials"] = MATERIALS
    scene["primitives"] = [{"type": "plane", "point": [0, 0, 0], "normal": [0, 1, 0],
                            "material": "snow"}]
    scene["groups"] = FIRS
    scene["instances"] = [{"group": group, "transforms": os.path.basename(name)}
                          for group, name in zip(FIRS, names) if os.path.getsize(name)]
    scene["lights"] = [SUN]
    with open(path, "w", encoding="utf-8") as file:
        json.dump(scene, file, indent=1)
        file.write("\n")


def write_hills(path):
    rng = random.Random(1980)
    groups = dict(FIRS)
    instances = []
    for x, z, size in place(rng, 640):
        name = rng.choice(("fir", "fir", "young fir", "tall fir", "tall fir"))
        steps = [{"scale": [round(size, 2), round(size * rng.uniform(0.9, 1.25), 2),
                            round(size, 2)]},
                 {"translate": [round(x, 2), round(ground(x, z), 2), round(z, 2)]}]
        instances.append({"group": name, "transform": steps})

    scene = dict(HEAD)
    scene["description"] = (f"{len(instances)} firs, three of which are in the file: each is a "
                            "group of cones, put in place by an affine transform of its own.")
    scene["materials"] = MATERIALS | {
        "logs": {"k_a": 0.35, "k_d": [0.26, 0.12, 0.06]},
        "window": {"k_e": [2.6, 1.5, 0.55]},
    }
    hx, hz = HOUSE
    hy = ground(hx, hz)
    lines = [{"type": "plane", "point": [0, 0, 0], "normal": [0, 1, 0], "material": "snow"}]
    for x, z, top, radius in HILLS:
        lines.append({"type": "sphere", "center": [x, top - radius, z], "radius": radius,
                      "material": "snow"})
    groups["house"] = [
        {"type": "box", "min": [-1.3, -0.5, -1], "max": [1.3, 1.15, 1], "material": "logs"},
        {"type": "box", "min": [-0.95, 0.4, 0.9], "max": [-0.45, 0.85, 1.02], "material": "window"},
        {"type": "box", "min": [0.5, 0.4, 0.9], "max": [1.0, 0.85, 1.02], "material": "window"},
        {"type": "box", "min": [-0.2, 0, 0.9], "max": [0.25, 0.85, 1.02], "material": "bark"},
        {"type": "mesh", "material": "snow",
         "positions": [[-1.6, 1.05, 1.3], [1.6, 1.05, 1.3], [1.6, 2.1, 0], [-1.6, 2.1, 0],
                       [-1.6, 1.05, -1.3], [1.6, 1.05, -1.3]],
         "triangles": [[0, 1, 2], [0, 2, 3], [5, 4, 3], [5, 3, 2], [0, 3, 4], [1, 5, 2],
                       [0, 4, 5], [0, 5, 1]]},
        {"type": "box", "min": [0.7, 1.2, -0.5], "max": [1.0, 2.4, -0.2], "material": "logs"},
    ]
    instances.append({"group": "house", "transform": [
        {"rotate": -14, "axis": [0, 1, 0]}, {"translate": [hx, round(hy, 2), hz]}]})
    scene["lights"] = [
        SUN,
        {"type": "point", "position": [hx, round(hy + 0.6, 2), hz + 1.9],
         "intensity": [1.6, 0.9, 0.35]},
    ]

    def rows(items):
        return ",\n    ".join(json.dumps(item) for item in items)

    text = json.dumps(scene, indent=2)[:-2]
    text += ',\n  "primitives": [\n    ' + rows(lines) + "\n  ]"
    text += ',\n  "groups": {\n    ' + ",\n    ".join(
        f'"{name}": [\n      ' + ",\n      ".join(json.dumps(p) for p in parts) + "\n    ]"
        for name, parts in groups.items()) + "\n  }"
    text += ',\n  "instances": [\n    ' + rows(instances) + "\n  ]\n}\n"
    with open(path, "w", encoding="utf-8") as file:
        file.write(text)


def main():
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("file", help="the scene to write, .json")
    parser.add_argument("--trees", type=int, help="a plain with so many firs, 1 to 16,777,215")
    arguments = parser.parse_args()
    if arguments.trees is None:
        write_hills(arguments.file)
    elif 1 <= arguments.trees < 2 ** 24:
        write_plain(arguments.file, arguments.trees)
    else:
        parser.error("--trees must be 1 to 16777215")


if __name__ == "__main__":
    main()
