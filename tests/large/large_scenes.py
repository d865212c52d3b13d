"""large_scenes.py triangles | instances: a million of them, and what each ray must meet by a formula.

Environment: TURNER, the command; TOOLS, the folder of exr.py. Exit status 77 without a device.
"""

import array
import json
import math
import os
import pathlib
import struct
import subprocess
import sys
import tempfile

sys.path.insert(0, os.environ["TOOLS"])
sys.dont_write_bytecode = True
import exr  # noqa: E402

WIDTH, HEIGHT, VFOV = 96, 64, 40
MATERIALS = {"grey": {"k_d": 0.5}}


def little(numbers):
    if sys.byteorder != "little":
        numbers.byteswap()
    return numbers.tobytes()


def render(scene, *layers):
    """The layers and the statistics."""
    pathlib.Path("scene.json").write_text(json.dumps(scene))
    command = [os.environ["TURNER"], "render", "scene.json", "-o", "a.exr", "--aov",
               ",".join(layers), "--size", f"{WIDTH}x{HEIGHT}", "--stats", "s.json", "-q"]
    done = subprocess.run(command, timeout=280, stderr=subprocess.PIPE, text=True)
    print(done.stderr, end="", file=sys.stderr)
    assert done.returncode == 0, f"status {done.returncode}"
    statistics = json.loads(pathlib.Path("s.json").read_text())
    print(statistics["seconds"], statistics["peak_bytes"])
    return exr.read("a.exr").channels, statistics


def unit(v):
    length = math.sqrt(sum(x * x for x in v))
    return [x / length for x in v]


def rays(eye, at):
    """Directions through the pixels' centres (docs/model.md, "Camera"), up +z."""
    w = unit([a - b for a, b in zip(eye, at)])
    u = unit([-w[1], w[0], 0])
    v = [w[1] * u[2] - w[2] * u[1], w[2] * u[0] - w[0] * u[2], w[0] * u[1] - w[1] * u[0]]
    s = 2 * math.tan(math.radians(VFOV) / 2) / HEIGHT
    for row in range(HEIGHT):
        for column in range(WIDTH):
            x, y = (column + 0.5 - WIDTH / 2) * s, (HEIGHT / 2 - row - 0.5) * s
            yield unit([x * a + y * b - c for a, b, c in zip(u, v, w)])


def triangles():
    """A flat mesh without gaps: every ray meets it at the depth of its plane."""
    n = 708
    positions = array.array("f")
    for j in range(n + 1):
        for i in range(n + 1):
            # neither on a lattice nor in its order; exact in floats, so that all lie in the plane
            positions.extend((i + (j * 37 % 64) / 256, j + (i * 23 % 64) / 256, 0))
    faces = bytearray()
    record = struct.Struct("<B3iB3i")
    for j in range(n):
        for i in range(n):
            a, b = j * (n + 1) + i, (j + 1) * (n + 1) + i
            faces += record.pack(3, a, a + 1, b + 1, 3, a, b + 1, b)
    count = 2 * n * n
    header = ("ply\nformat binary_little_endian 1.0\n"
              f"element vertex {(n + 1) ** 2}\nproperty float x\nproperty float y\n"
              f"property float z\nelement face {count}\n"
              "property list uchar int vertex_indices\nend_header\n")
    pathlib.Path("flat.ply").write_bytes(header.encode() + little(positions) + faces)
    eye, at = (354.3, 60.1, 90.7), (354.2, 354.9, 0)
    layers, statistics = render(
        {"version": 1, "camera": {"from": eye, "at": at, "up": [0, 0, 1], "vfov": VFOV},
         "materials": MATERIALS,
         "primitives": [{"type": "mesh", "file": "flat.ply", "material": "grey"}]}, "depth", "id")
    assert statistics["primitives"] == count
    met = 0
    for pixel, d in enumerate(rays(eye, at)):
        t = -eye[2] / d[2] if d[2] < 0 else math.inf
        x, y = eye[0] + t * d[0], eye[1] + t * d[1]
        if 1 < x < n - 1 and 1 < y < n - 1:
            met += 1
            depth = layers["depth.Z"][pixel]
            assert abs(depth - t) < 1e-5 * t, f"pixel {pixel}: depth {depth}, not {t}"
            assert layers["id.X"][pixel] == 1
    assert met > WIDTH * HEIGHT / 2, f"only {met} rays meet the mesh"
    peaks = statistics["peak_bytes"]
    assert peaks["device"] <= 120 * count, f"{peaks['device'] / count} bytes a triangle on the device"
    assert peaks["host"] <= 600 * count, f"{peaks['host'] / count} bytes a triangle in all"


def nearest(eye, d, n):
    """The sphere of radius 1/2 about a lattice point (i, j, 0) that the ray meets first, or None; and
    how far from the edge of a sphere it passes."""
    enter, leave = (-eye[2] + 0.5) / d[2], (-eye[2] - 0.5) / d[2]
    best, index, margin = math.inf, None, math.inf
    x = sorted((eye[0] + enter * d[0], eye[0] + leave * d[0]))
    y = sorted((eye[1] + enter * d[1], eye[1] + leave * d[1]))
    for i in range(max(0, math.floor(x[0] - 0.5)), min(n - 1, math.ceil(x[1] + 0.5)) + 1):
        for j in range(max(0, math.floor(y[0] - 0.5)), min(n - 1, math.ceil(y[1] + 0.5)) + 1):
            to = [i - eye[0], j - eye[1], -eye[2]]
            along = sum(a * b for a, b in zip(to, d))
            square = sum((a - along * b) ** 2 for a, b in zip(to, d))
            margin = min(margin, abs(math.sqrt(square) - 0.5))
            if square < 0.25 and along - math.sqrt(0.25 - square) < best:
                best, index = along - math.sqrt(0.25 - square), j * n + i
    return index, margin


def instances():
    """A million unit spheres, each half as large and turned over, on a square lattice."""
    n = 1000
    matrices = array.array("f")
    for j in range(n):
        for i in range(n):
            matrices.extend((0, 0.5, 0, i, -0.5, 0, 0, j, 0, 0, 0.5, 0))
    pathlib.Path("spheres.f32").write_bytes(little(matrices))
    eye, at = (500.3, 480.6, 9.4), (500.1, 500.2, 0)
    layers, statistics = render(
        {"version": 1, "camera": {"from": eye, "at": at, "up": [0, 0, 1], "vfov": VFOV},
         "materials": MATERIALS,
         "groups": {"ball": [{"type": "sphere", "center": [0, 0, 0], "radius": 1,
                              "material": "grey"}]},
         "instances": [{"group": "ball", "transforms": "spheres.f32"}]}, "id")
    assert statistics["instances"] == n * n
    sure, seen = 0, set()
    for pixel, d in enumerate(rays(eye, at)):
        index, margin = nearest(eye, d, n)
        if margin < 1e-4:
            continue
        sure += 1
        expected = 0 if index is None else 1 + index
        seen.add(expected)
        assert layers["id.X"][pixel] == expected, \
            f"pixel {pixel}: id {layers['id.X'][pixel]}, not {expected}"
    assert sure > 0.99 * WIDTH * HEIGHT and 0 in seen and len(seen) > 100, (sure, len(seen))


def main():
    probe = subprocess.run([os.environ["TURNER"], "devices"], capture_output=True, text=True)
    if probe.returncode != 0 or "bvh         yes" not in probe.stdout:
        print("skipped:", probe.stderr.strip() or "no Vulkan device has what turner requires")
        sys.exit(77)
    with tempfile.TemporaryDirectory() as folder:
        os.chdir(folder)
        {"triangles": triangles, "instances": instances}[sys.argv[1]]()
        os.chdir("/")


if __name__ == "__main__":
    main()
