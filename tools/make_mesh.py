#!/usr/bin/env python3
"""Writes a closed, watertight triangle mesh with smooth vertex normals.

  bumps  a sphere with bumps, for measurements: as many triangles as wanted
  knot   a torus knot with texture coordinates, for pictures

The ending of the file says the format: .ply (binary) or .obj.

Example: tools/make_mesh.py knot --triangles 40000 -o scenes/knot.ply
"""
import argparse
import math
import struct


class Mesh:
    def __init__(self):
        self.positions, self.normals, self.uvs, self.triangles = [], [], [], []


def sub(a, b):
    return (a[0] - b[0], a[1] - b[1], a[2] - b[2])


def cross(a, b):
    return (a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0])


def unit(v):
    length = math.sqrt(v[0] * v[0] + v[1] * v[1] + v[2] * v[2])
    return (v[0] / length, v[1] / length, v[2] / length)


def bump_height(d):
    """The radius in the unit direction d and its gradient, as a function of all of space."""
    radius, gradient = 1.0, [0.0, 0.0, 0.0]
    for (kx, ky, kz), phase, height in (((5, 3, -4), 0.3, 0.045), ((-3, 6, 5), 1.7, 0.04),
                                        ((9, -7, 8), 2.9, 0.02), ((4, 11, -10), 0.8, 0.015)):
        angle = kx * d[0] + ky * d[1] + kz * d[2] + phase
        radius += height * math.sin(angle)
        slope = height * math.cos(angle)
        gradient[0] += slope * kx
        gradient[1] += slope * ky
        gradient[2] += slope * kz
    return radius, gradient


def bumps(triangles):
    """The six faces of a cube, each n × n squares, blown up to a sphere: 12 n² triangles. Corners
    are known by their place on the cube's lattice, so that faces share those on their edges."""
    n = max(1, round(math.sqrt(triangles / 12)))
    mesh, numbers = Mesh(), {}

    def corner(i, j, k):
        if (i, j, k) in numbers:
            return numbers[i, j, k]
        # tan makes the squares about equal on the sphere
        d = unit(tuple(math.tan((c / n - 0.5) * math.pi / 2) for c in (i, j, k)))
        radius, gradient = bump_height(d)
        # the surface |p| = radius(p / |p|): normal = d − tangential part of the gradient / radius
        along = sum(g * c for g, c in zip(gradient, d))
        mesh.normals.append(unit(tuple(c - (g - along * c) / radius
                                       for c, g in zip(d, gradient))))
        mesh.positions.append(tuple(radius * c for c in d))
        numbers[i, j, k] = len(mesh.positions) - 1
        return numbers[i, j, k]

    for axis in range(3):
        for side in (0, n):
            for a in range(n):
                for b in range(n):
                    square = []
                    for u, v in ((a, b), (a + 1, b), (a + 1, b + 1), (a, b + 1)):
                        place = [side, u, v]  # axis, then the two that follow it
                        square.append(corner(*(place[(c - axis) % 3] for c in range(3))))
                    if side == 0:
                        square.reverse()
                    mesh.triangles.append((square[0], square[1], square[2]))
                    mesh.triangles.append((square[0], square[2], square[3]))
    return mesh


def knot_curve(t, p, q):
    """Point of the (p, q) torus knot at t in 0 … 2π."""
    r = 1 + 0.42 * math.cos(q * t)
    return (r * math.cos(p * t), 0.42 * math.sin(q * t), r * math.sin(p * t))


def knot(triangles, p=2, q=3, thickness=0.2):
    """A tube about the knot: rings of a frame carried along without twist, the rest of the turn
    spread evenly, so that the last ring meets the first. The seam's vertices are there twice, at
    the same place, because their texture coordinates differ."""
    sides = max(3, round(math.sqrt(triangles / 2 / 9)))
    rings = max(3, round(triangles / 2 / sides))
    points = [knot_curve(2 * math.pi * i / rings, p, q) for i in range(rings)]
    tangents = [unit(sub(points[(i + 1) % rings], points[i - 1])) for i in range(rings)]

    def carried(normal, tangent):
        along = sum(a * b for a, b in zip(normal, tangent))
        return unit(tuple(a - along * b for a, b in zip(normal, tangent)))

    frames = [carried((0, 1, 0), tangents[0])]
    for i in range(1, rings + 1):
        frames.append(carried(frames[-1], tangents[i % rings]))
    sideways = cross(tangents[0], frames[0])
    excess = math.atan2(sum(a * b for a, b in zip(frames[rings], sideways)),
                        sum(a * b for a, b in zip(frames[rings], frames[0])))
    mesh = Mesh()
    for i in range(rings + 1):
        tangent, center = tangents[i % rings], points[i % rings]
        normal = frames[i % rings]
        binormal = cross(tangent, normal)
        turned = -excess * (i % rings) / rings
        for j in range(sides + 1):
            angle = turned + 2 * math.pi * (j % sides) / sides
            if i == rings:  # exactly the first ring again
                angle = 2 * math.pi * (j % sides) / sides
            c, s = math.cos(angle), math.sin(angle)
            n = tuple(c * a + s * b for a, b in zip(normal, binormal))
            mesh.normals.append(n)
            mesh.positions.append(tuple(a + thickness * b for a, b in zip(center, n)))
            mesh.uvs.append((i / rings, j / sides))
    for i in range(rings):
        for j in range(sides):
            a, b = i * (sides + 1) + j, (i + 1) * (sides + 1) + j
            mesh.triangles.append((a, a + 1, b))
            mesh.triangles.append((a + 1, b + 1, b))
    return mesh


def write_ply(path, mesh):
    names = ["x", "y", "z", "nx", "ny", "nz"] + (["s", "t"] if mesh.uvs else [])
    with open(path, "wb") as out:
        header = ["ply", "format binary_little_endian 1.0", "comment made by tools/make_mesh.py",
                  f"element vertex {len(mesh.positions)}"]
        header += [f"property float {name}" for name in names]
        header += [f"element face {len(mesh.triangles)}",
                   "property list uchar int vertex_indices", "end_header", ""]
        out.write("\n".join(header).encode("ascii"))
        vertex = struct.Struct(f"<{len(names)}f")
        for i, (position, normal) in enumerate(zip(mesh.positions, mesh.normals)):
            out.write(vertex.pack(*position, *normal, *(mesh.uvs[i] if mesh.uvs else ())))
        face = struct.Struct("<B3i")
        for triangle in mesh.triangles:
            out.write(face.pack(3, *triangle))


def write_obj(path, mesh):
    with open(path, "w", encoding="ascii") as out:
        out.write("# made by tools/make_mesh.py\n")
        for x, y, z in mesh.positions:
            out.write(f"v {x:.7f} {y:.7f} {z:.7f}\n")
        for x, y, z in mesh.normals:
            out.write(f"vn {x:.5f} {y:.5f} {z:.5f}\n")
        for u, v in mesh.uvs:
            out.write(f"vt {u:.6f} {v:.6f}\n")
        for triangle in mesh.triangles:
            corners = (f"{i + 1}/{i + 1 if mesh.uvs else ''}/{i + 1}" for i in triangle)
            out.write("f " + " ".join(corners) + "\n")


def main():
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("shape", choices=("bumps", "knot"))
    parser.add_argument("--triangles", type=int, default=20000,
                        help="about as many triangles, 12 to 20,000,000 (20000)")
    parser.add_argument("-o", "--output", required=True, help="file to write, .ply or .obj")
    arguments = parser.parse_args()
    if not 12 <= arguments.triangles <= 20000000:
        parser.error("--triangles must be 12 to 20000000")
    if not arguments.output.endswith((".ply", ".obj")):
        parser.error("the output must end in .ply or .obj")
    mesh = (bumps if arguments.shape == "bumps" else knot)(arguments.triangles)
    (write_ply if arguments.output.endswith(".ply") else write_obj)(arguments.output, mesh)
    print(f"{arguments.output}: {len(mesh.triangles)} triangles, {len(mesh.positions)} vertices")


if __name__ == "__main__":
    main()
