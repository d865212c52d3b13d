"""`turner render --error`: what it takes, what it refuses, what it says, and that tiles leave no trace.

Environment: TURNER, the command. Exit status 77 without a Vulkan device.
"""

import json
import os
import pathlib
import subprocess
import tempfile

TURNER = os.environ["TURNER"]
SCENE = """{"version": 1, "camera": {"from": [0, 1, 5], "at": [0, 0, 0]},
 "background": 0.5, "settings": {"size": [40, 30]%s},
 "materials": {"glass": {"k_r": 1, "k_t": 1, "index": 1.5}, "grey": {"k_d": 0.5}},
 "primitives": [
  {"type": "sphere", "center": [0, 0, 0], "radius": 1, "material": "glass"},
  {"type": "box", "min": [-3, -2, -2], "max": [3, -1, 1], "material": "grey"}],
 "lights": [{"type": "point", "position": [2, 4, 3], "intensity": 30}]}"""

# between three mirrors of glass rays double at each step; without Fresnel nothing is lost
BALLS = """{"version": 1, "camera": {"from": [0, 0, 8], "at": [0, 0, 0]},
 "background": 0.5, "settings": {"size": [40, 30]},
 "materials": {"glass": {"k_r": 1, "k_t": 1, "index": 1.5, "fresnel": "none"}},
 "primitives": [
  {"type": "sphere", "center": [0, 0, 0], "radius": %(r)g, "material": "glass"},
  {"type": "sphere", "center": [%(r)g, 0, -%(r)g], "radius": %(r)g, "material": "glass"},
  {"type": "sphere", "center": [-%(r)g, 0, -%(r)g], "radius": %(r)g, "material": "glass"}]}"""


def turner(*arguments, status=0):
    done = subprocess.run([TURNER, "render", *arguments], capture_output=True, text=True,
                          timeout=300)
    print("$ turner render", *arguments, "=>", done.returncode, done.stdout, done.stderr, sep=" ")
    if done.returncode == 4:
        raise SystemExit(77)
    assert done.returncode == status, f"status {done.returncode}, not {status}"
    return done


def statistics(*arguments):
    turner(*arguments, "-q", "--stats", "stats.json")
    return json.loads(pathlib.Path("stats.json").read_text())


def main():
    pathlib.Path("scene.json").write_text(SCENE % "")
    pathlib.Path("asks.json").write_text(SCENE % ', "error": 0.05')

    said = turner("scene.json", "-o", "a.exr", "--error", "1/20", "--aov", "error,samples").stdout
    assert "error: estimated" in said and "samples a pixel" in said
    coarse = statistics("scene.json", "-o", "b.exr", "--error", "0.05", "--aov", "error,samples")
    assert coarse["error"]["asked"] == 0.05
    assert 0 < coarse["error"]["mean"] < coarse["error"]["max"]
    assert coarse["error"]["missed"] or coarse["error"]["max"] <= 0.05
    asked = statistics("asks.json", "-o", "c.exr", "--aov", "error,samples")
    assert asked["error"] == coarse["error"], "the scene's error is not the command line's"

    fine = statistics("scene.json", "-o", "d.exr", "--error", "0.01")
    assert fine["error"]["mean"] < coarse["error"]["mean"]
    assert fine["samples"]["mean"] > coarse["samples"]["mean"]
    assert fine["error"]["cutoff_least"] < coarse["error"]["cutoff_least"]

    turner("scene.json", "-o", "tiles.exr", "--error", "0.05", "--tile", "7", "-q")
    turner("scene.json", "-o", "whole.exr", "--error", "0.05", "-q")
    assert pathlib.Path("tiles.exr").read_bytes() == pathlib.Path("whole.exr").read_bytes()

    pathlib.Path("large.json").write_text(BALLS % {"r": 3})
    said = turner("large.json", "-o", "f.exr", "--error", "0.05", status=2).stderr
    assert "rays on average" in said and "--method fresnel=exact" in said
    pathlib.Path("small.json").write_text(BALLS % {"r": 0.1})
    few = statistics("small.json", "-o", "few.exr", "--error", "0.05")
    assert 0 < few["error"]["missed"] < 100 and few["error"]["max"] > 1, "cut rays are no error"

    given = statistics("asks.json", "-o", "e.exr", "--spp", "2")
    assert "error" not in given and given["samples"] == {"mean": 2, "max": 2}
    for wrong in ("0", "-1", "1/0", "x", "1/", "nan", "1/255/2"):
        assert "--error" in turner("scene.json", "-o", "f.exr", "--error", wrong, status=2).stderr
    turner("scene.json", "-o", "f.exr", "--error", "0.1", "--spp", "4", status=2)
    turner("scene.json", "-o", "f.exr", "--error", "0.1", "-d", "reference", status=2)
    assert not pathlib.Path("f.exr").exists()


with tempfile.TemporaryDirectory() as folder:
    os.chdir(folder)
    main()
