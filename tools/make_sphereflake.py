#!/usr/bin/env python3
"""Writes a sphereflake: a sphere with nine spheres of a third of its size on it, and so on.

The spheres are those of the "balls" scene of Eric Haines's Standard Procedural Databases (depth 4
has 7,381 of them, depth 5 66,430). Two kinds of scene come out:

  --format nff   the database's own scene: floor, camera and lights as published, z up
  --format json  a composed picture: gold and coral in the evening, y up, made of instances of one twig

Example: tools/make_sphereflake.py --depth 5 --format json -o scenes/sphereflake.json
"""
import argparse
import json
import math
import sys


def rotation(axis, angle):
    """The matrix (rows) that turns about the unit vector axis."""
    x, y, z = axis
    c, s, t = math.cos(angle), math.sin(angle), 1 - math.cos(angle)
    return ((t * x * x + c, t * x * y - s * z, t * x * z + s * y),
            (t * x * y + s * z, t * y * y + c, t * y * z - s * x),
            (t * x * z - s * y, t * y * z + s * x, t * z * z + c))


def apply(m, v):
    return tuple(sum(a * b for a, b in zip(row, v)) for row in m)


def unit(v):
    length = math.sqrt(sum(a * a for a in v))
    return tuple(a / length for a in v)


def child_directions():
    """Nine directions about +z: three on the equator's side in each third of a turn."""
    d = 1 / math.sqrt(2)
    tilt = rotation(unit((1, -1, 0)), math.asin(2 / math.sqrt(6)))
    trio = [apply(tilt, v) for v in ((d, d, 0), (d, 0, -d), (0, d, -d))]
    return [apply(rotation((0, 0, 1), turn * 2 * math.pi / 3), v)
            for turn in range(3) for v in trio]


CHILDREN = child_directions()


def towards(direction):
    """The matrix that turns +z to the unit vector direction."""
    x, y, z = direction
    if z > 1 - 1e-9:
        return ((1, 0, 0), (0, 1, 0), (0, 0, 1))
    if z < -1 + 1e-9:  # straight down but for rounding
        return ((-1, 0, 0), (0, 1, 0), (0, 0, -1))
    return rotation(unit((-y, x, 0)), math.acos(z))


def flake(depth, center, direction, radius):
    """Yields (center, radius) of a sphere that points in `direction`, and of all on it."""
    yield center, radius
    if depth == 0:
        return
    turn, distance = towards(direction), radius * 4 / 3
    for child in CHILDREN:
        way = apply(turn, child)
        yield from flake(depth - 1, tuple(c + distance * w for c, w in zip(center, way)), way,
                         radius / 3)


def write_nff(out, spheres):
    out.write("b 0.078 0.361 0.753\nv\nfrom 2.1 1.3 1.7\nat 0 0 0\nup 0 0 1\nangle 45\n"
              "hither 0.01\nresolution 512 512\nl 4 3 2\nl 1 -4 4\nl -3 1 5\n"
              "f 1 0.75 0.33 0.8 0 100000 0 1\np 4\n12 12 -0.5\n-12 12 -0.5\n-12 -12 -0.5\n"
              "12 -12 -0.5\nf 1 0.9 0.7 0.5 0.5 3.0827 0 1\n")
    for (x, y, z), radius in spheres:
        out.write(f"s {x:.6g} {y:.6g} {z:.6g} {radius:.6g}\n")


TWIG = 3  # generations of the group that is put many times


def branches(depth, frame, center, radius):
    """Yields (depth left, frame, center, radius) of every sphere that is no part of a twig, and of
    each twig's first one (depth left TWIG or less). A child's frame (a rotation) is its parent's,
    turned on: so all twigs are one shape, and differ from flake()'s by a turn about themselves."""
    yield depth, frame, center, radius
    if depth <= TWIG:
        return
    for child in CHILDREN:
        way = apply(frame, child)
        columns = (apply(frame, column) for column in zip(*towards(child)))
        yield from branches(depth - 1, tuple(zip(*columns)),
                            tuple(c + radius * 4 / 3 * w for c, w in zip(center, way)), radius / 3)


def write_json(out, depth):
    count = (9 ** (depth + 1) - 1) // 8
    scene = {
        "$schema": "schema.json",
        "version": 1,
        "description": f"A sphereflake of {count:,} spheres: each carries nine of a third of "
                       f"its size, {depth} times over. Only the last twigs are in the file; their "
                       "instances make the rest. Written by tools/make_sphereflake.py.",
        "settings": {"size": [640, 480], "spp": 4, "depth": 3, "cutoff": 0.02},
        "camera": {"from": [1.9, 1.25, 2.9], "at": [0.02, 0.46, 0], "vfov": 30},
        "ambient": [0.20, 0.21, 0.24],
        "background": {"type": "gradient", "bottom": [1.5, 0.95, 0.60], "top": [0.04, 0.20, 0.62]},
        "materials": {
            "gold": {"metal": "gold", "k_d": [0.10, 0.06, 0.02], "k_a": [0.1, 0.07, 0.02],
                     "k_s": 0.05, "k_r": 0.95, "exponent": 120},
            "twig 0": {"k_d": [0.30, 0.02, 0.05], "k_a": [0.30, 0.02, 0.05]},
            "twig 1": {"k_d": [0.72, 0.10, 0.05], "k_a": [0.72, 0.10, 0.05]},
            "twig 2": {"k_d": [0.95, 0.50, 0.20], "k_a": [0.95, 0.50, 0.20]},
            "twig 3": {"k_d": [0.95, 0.80, 0.55], "k_a": [0.95, 0.80, 0.55]},
            "floor": {"k_d": [0.03, 0.045, 0.07], "k_a": [0.03, 0.04, 0.06], "k_r": 0.10},
        },
        "lights": [
            {"type": "directional", "direction": [-0.5, -1, -0.35], "irradiance": [4, 3.5, 2.9]},
            {"type": "point", "position": [-3, 4, 3], "intensity": [6, 6.5, 8]},
        ],
    }

    def up(v):  # z up becomes y up
        return v[1], v[2], v[0]

    spheres, instances = [], []
    for left, frame, center, radius in branches(depth, towards((0, 0, 1)), (0, 0, 0.5), 0.5):
        if left > TWIG:
            spheres.append(sphere(up(center), radius, "gold"))
            continue
        rows = [[radius * v for v in up(row)] + [c] for row, c in zip(frame, center)]
        matrix = [round(v, 6) for row in up(rows) for v in row]
        instances.append({"group": "twig", "transform": {"matrix": matrix}})
    twig = [sphere(up(center), radius, f"twig {round(-math.log(radius, 3))}")
            for center, radius in flake(min(depth, TWIG), (0, 0, 0), (0, 0, 1), 1)]
    floor = {"type": "plane", "point": [0, 0, 0], "normal": [0, 1, 0], "material": "floor"}

    def listed(items, indent):
        return "[\n" + ",\n".join(indent + json.dumps(i) for i in items) + "\n" + indent[2:] + "]"

    out.write(json.dumps(scene, indent=2)[:-2]
              + ',\n  "primitives": ' + listed([floor] + spheres, "    ")
              + ',\n  "groups": {\n    "twig": ' + listed(twig, "      ") + "\n  }"
              + ',\n  "instances": ' + listed(instances, "    ") + "\n}\n")


def sphere(center, radius, material):
    return {"type": "sphere", "center": [round(c, 6) for c in center],
            "radius": round(radius, 6), "material": material}


def main():
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--depth", type=int, default=4, help="generations of children, 0 to 6 (4)")
    parser.add_argument("--format", choices=("nff", "json"), help="default: the name's ending")
    parser.add_argument("-o", "--output", help="file to write; standard output if not given")
    arguments = parser.parse_args()
    if not 0 <= arguments.depth <= 6:
        parser.error("--depth must be 0 to 6")
    form = arguments.format
    if not form:
        form = "nff" if (arguments.output or "").endswith(".nff") else "json"
    out = open(arguments.output, "w", encoding="utf-8") if arguments.output else sys.stdout
    with out:
        if form == "nff":
            write_nff(out, flake(arguments.depth, (0, 0, 0), (0, 0, 1), 0.5))
        else:
            write_json(out, arguments.depth)


if __name__ == "__main__":
    main()
