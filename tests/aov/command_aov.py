"""command_aov.py files | adaptive | refusals | nonfinite: `turner render --aov`.

Environment: TURNER, the command; TOOLS, the folder of exr.py. Exit status 77 without a device.
"""

import json
import math
import os
import pathlib
import subprocess
import sys
import tempfile

sys.path.insert(0, os.environ["TOOLS"])
sys.dont_write_bytecode = True
import exr  # noqa: E402

TURNER = os.environ["TURNER"]
SCENE = {
    "version": 1, "camera": {"from": [0, 1, 5], "at": [0, 0, 0]}, "background": 0.5,
    "settings": {"size": [40, 30], "spp": 2, "depth": 5},
    "materials": {"glass": {"k_r": 1, "k_t": 1, "index": 1.5}, "grey": {"k_d": 0.5}},
    "primitives": [
        {"type": "sphere", "center": [0, 0, 0], "radius": 1, "material": "glass"},
        {"type": "box", "min": [-3, -2, -2], "max": [3, -1, 1], "material": "grey"}],
    "lights": [{"type": "point", "position": [2, 4, 3], "intensity": 30}]}
REAL = {"R", "G", "B", "albedo.R", "albedo.G", "albedo.B", "depth.Z", "normal.X", "normal.Y",
        "normal.Z", "position.X", "position.Y", "position.Z", "pruned.X", "error.X"}
WHOLE = {"id.X", "nonfinite.X", "rays.X", "recursion.X", "samples.X"}


def turner(*arguments, status=0):
    print("$ turner", *arguments)
    done = subprocess.run([TURNER, *arguments], capture_output=True, text=True, timeout=300)
    print(done.stdout[:2000], done.stderr, "=>", done.returncode, sep="")
    assert done.returncode == status, f"status {status} was expected"
    return done


def files():
    """Names, types and values other programs find; the same bytes whatever the tile; RGB, texts and
    statistics as without layers."""
    pathlib.Path("scene.json").write_text(json.dumps(SCENE))
    for device in ([], ["--device", "reference"]):
        plain = json.loads(turner("render", "scene.json", "-o", "plain.exr", "--stats", "-",
                                  *device).stdout)
        told = json.loads(turner("render", "scene.json", "-o", "a.exr", "--aov", "all", "--stats",
                                 "-", *device).stdout)
        turner("render", "scene.json", "-o", "b.exr", "--aov", "all", "--tile", "7", "-q", *device)
        assert pathlib.Path("a.exr").read_bytes() == pathlib.Path("b.exr").read_bytes(), "bytes"
        for what in ("rays", "largest_depth", "pruned", "nonfinite"):
            assert plain[what] == told[what], what

        picture, layers = exr.read("plain.exr"), exr.read("a.exr")
        assert {n for n, c in layers.channels.items() if c.typecode == "f"} == REAL
        assert {n for n, c in layers.channels.items() if c.typecode == "I"} == WHOLE
        for name in "RGB":
            assert picture.channels[name] == layers.channels[name], name
        for text in ("turner:version", "turner:device", "turner:settings"):
            assert picture.attributes[text] == layers.attributes[text], text

        c = layers.channels
        assert sum(c["rays.X"]) == sum(
            told["rays"][kind] for kind in ("camera", "reflected", "refracted", "shadow")), "rays"
        assert max(c["recursion.X"]) == told["largest_depth"], "recursion"
        assert set(c["samples.X"]) == {2} and set(c["nonfinite.X"]) == {0}
        assert math.isclose(max(c["pruned.X"]), told["pruned"]["max"], rel_tol=1e-6), "pruned"
        middle = 15 * 40 + 20  # half a pixel off the middle: the sphere, √26 − 1 away
        assert c["id.X"][middle] == 1 and abs(c["depth.Z"][middle] - (math.sqrt(26) - 1)) < 0.01
        away = [c[f"normal.{x}"][middle] for x in "XYZ"]
        assert abs(away[1] - 1 / math.sqrt(26)) < 0.05 and abs(away[2] - 5 / math.sqrt(26)) < 0.05
        assert min(c["error.X"]) > 0 and max(c["error.X"]) < math.inf, "error"
        assert c["id.X"][0] == 0 and c["depth.Z"][0] == math.inf, "background"
        assert set(c["albedo.G"]) == {0, 0.5}, "albedo"
        assert turner("compare", "plain.exr", "a.exr", "--threshold", "0"), "compare"
    turner("render", "scene.json", "-o", "one.exr", "--aov", "depth", "--aov", "id", "-q")
    assert set(exr.read("one.exr").channels) == {"R", "G", "B", "depth.Z", "id.X"}


def adaptive():
    """A ray a sample where there is neither light nor mirror; the same bytes whatever the tile."""
    scene = json.loads(json.dumps(SCENE))
    scene["lights"] = []
    scene["materials"]["glass"] = {"k_e": 1}
    pathlib.Path("dark.json").write_text(json.dumps(scene))
    pathlib.Path("scene.json").write_text(json.dumps(SCENE))
    method = ["--method", "aa=adaptive:0.05,61", "--aov", "all", "-q"]
    turner("render", "dark.json", "-o", "dark.exr", *method)
    c = exr.read("dark.exr").channels
    shared = 0
    for rays, samples in zip(c["rays.X"], c["samples.X"]):
        # 5, then 13; squares divided further may share samples, which `samples` counts twice
        assert rays == samples if samples <= 13 else 13 < rays <= samples, (rays, samples)
        shared += rays < samples
    assert min(c["samples.X"]) == 5 and shared > 40 and set(c["recursion.X"]) == {0}

    done = turner("render", "scene.json", "-o", "a.exr", *method, "--stats", "-")
    turner("render", "scene.json", "-o", "b.exr", *method, "--tile", "7")
    assert pathlib.Path("a.exr").read_bytes() == pathlib.Path("b.exr").read_bytes(), "bytes"
    told, c = json.loads(done.stdout), exr.read("a.exr").channels
    assert max(c["recursion.X"]) == told["largest_depth"] == 5, "recursion"
    assert all(r >= s or s > 13 for r, s in zip(c["rays.X"], c["samples.X"])), "rays"


def refusals():
    """Wrong names and formats: status 2, before any work, and nothing is left behind."""
    pathlib.Path("scene.json").write_text(json.dumps(SCENE))
    done = turner("render", "scene.json", "-o", "p.exr", "--aov", "depth,normals", status=2)
    assert '"normals"; did you mean "normal"?' in done.stderr
    for ending in ("png", "tif"):
        done = turner("render", "scene.json", "-o", f"p.{ending}", "--aov", "depth", status=2)
        assert ".exr" in done.stderr, "what to do"
    for device in ([], ["--device", "reference"]):
        done = turner("render", "scene.json", "-o", "p.exr", "--aov", "all", "--size",
                      "65536x65536", *device, status=4)
        assert "with its layers" in done.stderr and "MiB" in done.stderr
    assert [p.name for p in pathlib.Path().iterdir()] == ["scene.json"], "something was written"


def nonfinite():
    """Pixels that are not finite stand in the layer, as many as are counted."""
    scene = json.loads(json.dumps(SCENE))
    scene["materials"]["grey"] |= {"k_e": 3e38, "k_a": 1}  # twice 3e38 is beyond a float
    scene["ambient"] = 3e38
    pathlib.Path("scene.json").write_text(json.dumps(scene))
    for device in ([], ["--device", "reference"]):
        done = turner("render", "scene.json", "-o", "p.exr", "--aov", "nonfinite", "--stats", "-",
                      *device)
        told = json.loads(done.stdout)["nonfinite"]
        c = exr.read("p.exr").channels
        assert sum(c["nonfinite.X"]) == told["count"] > 0
        x, y = told["first"]
        assert c["nonfinite.X"].index(1) == 40 * y + x
        for flag, *rgb in zip(c["nonfinite.X"], c["R"], c["G"], c["B"]):
            assert flag == (not all(map(math.isfinite, rgb)))


def main():
    probe = subprocess.run([TURNER, "devices"], capture_output=True, text=True)
    if probe.returncode != 0 or "bvh         yes" not in probe.stdout:
        print("skipped:", probe.stderr.strip() or "no Vulkan device has what turner requires")
        sys.exit(77)
    with tempfile.TemporaryDirectory(prefix="turner-layers-") as folder:
        os.chdir(folder)
        {"files": files, "adaptive": adaptive, "refusals": refusals,
         "nonfinite": nonfinite}[sys.argv[1]]()
        os.chdir("/")


main()
