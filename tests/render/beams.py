#!/usr/bin/env python3
"""Shadow rays that are traced together find what each of them finds: beams.py TURNER.

Packets take shadow rays to a light as one where they stay together (shaders/packet.glsl); lane by
lane each is met with every box. The pictures must be the same to the bit: lights from afar, two that
almost coincide, one among the shapes, one a hair above a surface, one that lies along an axis from
what it lights; tinted shadows; shapes in the world, and in a group that is shrunk and one that is
blown up."""
import json
import math
import pathlib
import random
import subprocess
import sys
import tempfile

TURNER = sys.argv[1]
SIZE = "96x72"
failures = []


def turner(*arguments):
    run = subprocess.run([TURNER, *map(str, arguments)], capture_output=True, text=True)
    if run.returncode != 0:
        failures.append(f"turner {' '.join(map(str, arguments))}: status {run.returncode}, "
                        f"{run.stdout.strip()} {run.stderr.strip()}")


def shapes(number, reach):
    """Spheres, boxes and cylinders of very different sizes about the origin."""
    found = []
    for i in range(number):
        center = [random.uniform(-reach, reach) for _ in range(3)]
        size = reach * math.exp(random.uniform(-5, -1.6))
        material = "glass" if i % 7 == 0 else "paint"
        if i % 3 == 0:
            found.append({"type": "box", "min": [x - size for x in center],
                          "max": [x + size for x in center], "material": material})
        elif i % 3 == 1:
            found.append({"type": "cylinder", "base": center, "radius": size / 2,
                          "apex": [center[0] + size, center[1], center[2]], "material": material})
        else:
            found.append({"type": "sphere", "center": center, "radius": size,
                          "material": material})
    return found


def light(*position):
    return {"type": "point", "position": position, "intensity": 1, "falloff": "none"}


def scene_of(instances):
    floor = {"type": "box", "min": [-3, -1.2, -3], "max": [3, -1, 3], "material": "paint"}
    scene = {
        "version": 1, "settings": {"depth": 1, "shadows": "tinted"},
        "camera": {"from": [0.3, 1.9, 5.5], "at": [0, -0.2, 0], "vfov": 38},
        "background": 0.2,
        "materials": {"paint": {"k_d": [0.7, 0.6, 0.5]},
                      "glass": {"k_d": 0.2, "k_t": [0.5, 0.7, 0.6], "index": 1.0}},
        "primitives": [floor],
        "lights": [light(5, 9, 4), light(5, 9, 4.0001), light(0.1, 0.2, 0.1),
                   light(0.7, -0.999, 1.9), light(-0.5, 4, 0), light(900, 1500, 400),
                   {"type": "directional", "direction": [-1, -2, -1], "irradiance": 0.3}],
    }
    if instances:
        scene["groups"] = {"small": shapes(150, 0.01), "large": shapes(150, 300)}
        scene["instances"] = [
            {"group": "small", "transform": [{"scale": 70}, {"translate": [-0.9, -0.2, 0]}]},
            {"group": "large", "transform": [{"scale": 0.003}, {"rotate": 40, "axis": [0, 1, 0]},
                                             {"translate": [0.9, 0, 0.4]}]}]
    else:
        scene["primitives"] += shapes(400, 1)
    return scene


def main():
    devices = subprocess.run([TURNER, "devices"], capture_output=True, text=True).stdout
    if "in packets of 8 lanes" not in devices:
        print("skipped: no device has packets")
        return 77
    random.seed(7)
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        for instances in (False, True):
            scene = folder / f"instances-{instances}.json"
            scene.write_text(json.dumps(scene_of(instances)))
            pictures = [folder / "packet.exr", folder / "lane.exr"]
            for traversal, picture in zip(("bvh_packet", "bvh_lane"), pictures):
                turner("render", scene, "-o", picture, "-q", "--size", SIZE, "--spp", 1,
                       "--traversal", traversal)
            turner("compare", *pictures, "-t", 0)
    print("\n".join(failures))
    return 1 if failures else 0


if __name__ == "__main__":
    sys.exit(main())
