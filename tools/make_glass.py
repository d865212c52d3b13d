#!/usr/bin/env python3
"""Turns a drinking glass on the lathe: make_glass.py FILE.ply.

A closed mesh about the y axis, 1.3 high, with rounded edges and smooth normals; outside
counter-clockwise. The cavity is 0.09 above the ground; wall and bottom are solid."""
import math
import struct
import sys

SEGMENTS = 80
ARC = 5 # steps of a rounded edge


def corner(center, radius, start, end):
    """Points and normals of an arc, angles in degrees."""
    out = []
    for i in range(ARC + 1):
        a = math.radians(start + (end - start) * i / ARC)
        n = (math.cos(a), math.sin(a))
        out.append((center[0] + abs(radius) * n[0], center[1] + abs(radius) * n[1],
                    n[0] * math.copysign(1, radius), n[1] * math.copysign(1, radius)))
    return out


def profile():
    """(r, y, normal r, normal y) from the axis below, up outside, over the rim, down inside. A
    negative radius is a hollow edge, whose normal points to its centre."""
    lean = 3.2 # degrees the walls lean outward
    foot = corner((0.305, 0.05), 0.05, -90, -lean)
    rim = corner((0.398, 1.276), 0.024, -lean, 180 - lean)
    hollow = corner((0.232, 0.17), -0.08, -lean, -90)
    return [(0, 0, 0, -1)] + foot + rim + hollow + [(0, 0.09, 0, 1)]


def main():
    if len(sys.argv) != 2:
        sys.exit(__doc__)
    points = profile()
    vertices, triangles, rings = [], [], []
    for r, y, nr, ny in points:
        if r == 0:
            rings.append([len(vertices)] * SEGMENTS)
            vertices.append((0, y, 0, 0, ny, 0))
            continue
        rings.append(range(len(vertices), len(vertices) + SEGMENTS))
        for s in range(SEGMENTS):
            a = 2 * math.pi * s / SEGMENTS
            vertices.append((r * math.sin(a), y, r * math.cos(a),
                             nr * math.sin(a), ny, nr * math.cos(a)))
    for low, high in zip(rings, rings[1:]):
        for s in range(SEGMENTS):
            t = (s + 1) % SEGMENTS
            if low[s] != low[t]:
                triangles.append((low[s], low[t], high[t]))
            if high[s] != high[t]:
                triangles.append((low[s], high[t], high[s]))
    with open(sys.argv[1], "wb") as file:
        file.write(("ply\nformat binary_little_endian 1.0\n"
                    f"element vertex {len(vertices)}\n"
                    + "".join(f"property float {p}\n" for p in ("x", "y", "z", "nx", "ny", "nz"))
                    + f"element face {len(triangles)}\n"
                    "property list uchar int vertex_indices\nend_header\n").encode())
        for vertex in vertices:
            file.write(struct.pack("<6f", *vertex))
        for triangle in triangles:
            file.write(struct.pack("<B3i", 3, *triangle))


if __name__ == "__main__":
    main()
