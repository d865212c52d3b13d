"""The scene generators in tools/: meshes are closed and wound outward, their normals fit, and the
sphereflake is the one of the SPD. Usage: check_generators.py SOURCE_DIR BINARY_DIR SHARED_DIR"""
import json
import math
import pathlib
import struct
import subprocess
import sys

SOURCE, BINARY, SHARED = (pathlib.Path(argument) for argument in sys.argv[1:4])


def run(tool, *arguments):
    subprocess.run([sys.executable, str(SOURCE / "tools" / tool), *map(str, arguments)],
                   check=True, stdout=subprocess.DEVNULL)


def read_ply(path):
    """(positions, normals, triangles) of a binary PLY as make_mesh.py writes it."""
    header, body = path.read_bytes().split(b"end_header\n", 1)
    counts = [int(line.split()[-1]) for line in header.decode().splitlines()
              if line.startswith("element")]
    width = header.count(b"property float")
    vertices = list(struct.iter_unpack(f"<{width}f", body[:counts[0] * width * 4]))
    faces = list(struct.iter_unpack("<B3i", body[counts[0] * width * 4:]))
    assert len(faces) == counts[1] and all(face[0] == 3 for face in faces)
    return [v[:3] for v in vertices], [v[3:6] for v in vertices], [face[1:] for face in faces]


def read_obj(path):
    lines = [line.split() for line in path.read_text().splitlines()]
    positions = [tuple(map(float, line[1:])) for line in lines if line[0] == "v"]
    normals = [tuple(map(float, line[1:])) for line in lines if line[0] == "vn"]
    triangles = [tuple(int(corner.split("/")[0]) - 1 for corner in line[1:])
                 for line in lines if line[0] == "f"]
    return positions, normals, triangles


def check_mesh(positions, normals, triangles, wanted):
    assert abs(len(triangles) - wanted) < 0.1 * wanted, len(triangles)
    edges, volume = set(), 0
    for triangle in triangles:
        a, b, c = (positions[i] for i in triangle)
        for edge in ((a, b), (b, c), (c, a)):
            assert edge[0] != edge[1] and edge not in edges, edge
            edges.add(edge)
        u, v = ([q - p for p, q in zip(a, other)] for other in (b, c))
        ng = (u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0])
        volume += sum(p * n for p, n in zip(a, ng)) / 6
        for i in triangle:
            assert abs(sum(n * n for n in normals[i]) - 1) < 1e-4
            assert sum(p * n for p, n in zip(normals[i], ng)) > 0
    assert all((b, a) in edges for a, b in edges), "not closed"
    assert volume > 0


for shape in ("bumps", "knot"):
    for ending, read in ((".ply", read_ply), (".obj", read_obj)):
        path = BINARY / f"generated_{shape}{ending}"
        run("make_mesh.py", shape, "--triangles", 3000, "-o", path)
        check_mesh(*read(path), 3000)

path = BINARY / "generated_flake.json"
run("make_sphereflake.py", "--depth", 4, "-o", path)
flake = json.loads(path.read_text())
spheres = [(p["center"], p["radius"]) for p in flake["primitives"] if p["type"] == "sphere"]
for instance in flake["instances"]:
    m = instance["transform"]["matrix"]
    rows = [(m[i:i + 3], m[i + 3]) for i in (0, 4, 8)]
    scale = math.hypot(*rows[0][0])
    spheres += [([sum(a * c for a, c in zip(row, p["center"])) + shift for row, shift in rows],
                 scale * p["radius"]) for p in flake["groups"]["twig"]]
assert len(spheres) == 7381 and min(center[1] - radius for center, radius in spheres) > -1e-5
# every sphere but the first touches one three times its size
large = [s for s in spheres if s[1] > 0.015]
for center, radius in spheres[::37]:
    assert radius > 0.4 or any(abs(math.dist(center, c) - r - radius) < 1e-5 and
                               abs(r - 3 * radius) < 1e-5 for c, r in large)

published = SHARED / "scenes" / "nff" / "balls.nff"
if published.exists():
    path = BINARY / "generated_balls.nff"
    run("make_sphereflake.py", "--depth", 4, "-o", path)
    for ours, theirs in zip(path.read_text().split(), published.read_text().split(), strict=True):
        assert ours == theirs or abs(float(ours) - float(theirs)) < 2e-6, (ours, theirs)
else:
    print("the sphereflake is not compared:", published, "is not there")
