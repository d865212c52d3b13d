"""explain_command.py usage | reference | device: what `turner explain` says.

Environment: TURNER, the command; TURNER_SOURCE, the root of the project. Exit
status 77 without a Vulkan device where one is needed.
"""

import json
import math
import os
import pathlib
import re
import subprocess
import sys
import tempfile

TURNER = os.environ["TURNER"]
SCENES = pathlib.Path("scenes")  # a link in the folder of the test
USAGE, BAD_INPUT = 2, 3

# A ball that fills the picture from 4000 radii away: the textbook's quadratic has lost it.
FAR_BALL = """{"version": 1, "camera": {"from": [0, 0, 4000], "at": [0, 0, 0], "vfov": 0.03},
 "settings": {"size": [9, 9]}, "background": {"type": "gradient", "bottom": 0.1, "top": 1},
 "materials": {"mirror": {"k_r": 0.9}},
 "primitives": [{"type": "sphere", "center": [0, 0, 0], "radius": 1, "material": "mirror"}]}"""

# What the mirror shows is lit from 1e-4 away by so much that J/d² is no float, the pixel is one.
BEYOND_FLOATS = """{"version": 1, "camera": {"from": [0, 0, 5], "at": [0, 0, 0]},
 "settings": {"size": [1, 1], "cutoff": 0},
 "materials": {"mirror": {"k_r": 1e-15}, "wall": {"k_d": 0.5}},
 "primitives": [
  {"type": "plane", "point": [0, 0, 0], "normal": [0, 0, 1], "material": "mirror"},
  {"type": "plane", "point": [0, 0, 8], "normal": [0, 0, -1], "material": "wall"}],
 "lights": [{"type": "point", "position": [0, 0, 7.9999], "intensity": 1e35}]}"""


def turner(*arguments, status=0):
    print("$ turner", *arguments)
    done = subprocess.run([TURNER, *map(str, arguments)], capture_output=True, text=True,
                          timeout=300)
    print(done.stdout[:1500], done.stderr, "=>", done.returncode, sep="")
    assert done.returncode == status, f"exit status {done.returncode}, not {status}"
    return done


def explain_text(*arguments):
    text = turner("explain", *arguments).stdout
    for line in text.splitlines():
        assert len(line) <= 100, f"{len(line)} columns: {line}"
    return text


def explain_json(*arguments):
    return json.loads(turner("explain", *arguments, "--json").stdout)


def explain(*arguments):
    """Text and JSON of the same."""
    return explain_text(*arguments), explain_json(*arguments)


def close(a, b, relative):
    return abs(a - b) <= relative * max(abs(a), abs(b))


def usage():
    """Wrong command lines end with 2 and say what is right."""
    scene = SCENES / "bubble.json"
    assert "--pixel" in turner("explain", "--help").stdout
    for pixel in ("640,0", "0,480", "-1,0", "0,-1"):
        said = turner("explain", scene, "--pixel=" + pixel, status=USAGE).stderr
        assert "640x480" in said, "the size of the picture is not said"
    said = turner("explain", scene, "--size", "8x6", "-p", "8,0", status=USAGE).stderr
    assert "8x6" in said
    for pixel in ("", "5", "5,", "a,b", "5,5,5", "5.5,5", "99999999999,0"):
        assert "--pixel" in turner("explain", scene, "-p", pixel, status=USAGE).stderr
    turner("explain", scene, status=USAGE)
    turner("explain", "-p", "1,1", status=USAGE)
    said = turner("explain", scene, "-p", "1,1", "--sample", 4, status=USAGE).stderr
    assert "4 samples" in said, "the number of samples is not said"
    turner("explain", scene, "-p", "1,1", "--bits", 0, status=USAGE)
    turner("explain", scene, "-p", "1,1", "-m", "sphere=square", status=USAGE)
    turner("explain", "no.json", "-p", "1,1", status=BAD_INPUT)


def reference():
    """The reference alone: its rays add up, in both forms of output."""
    text, tree = explain(SCENES / "bubble.json", "-p", "320,240", "--depth", 3, "-d", "reference")
    assert "device" not in tree and "pairs" not in tree and "part" not in text
    rays = tree["reference"]["rays"]
    assert tree["pixel"] == [320, 240] and tree["sample"] == [0.5, 0.5]
    assert text.count("\n#") + text.count(" #") == len(rays), "not every ray is in the text"
    for c in range(3):
        total = math.fsum(ray["contribution"][c] for ray in rays)
        assert close(total, tree["reference"]["radiance"][c], 1e-15), "they do not add up"
    first = rays[0]
    assert first["kind"] == "camera" and first["parent"] is None
    assert first["hit"]["kind"] == "triangle" and first["hit"]["material"] == "glass"
    assert first["origin"] == [1.3, 1.75, 6.2] and first["n2"] == 1.5
    assert any(ray["media"] and ray["media"][0]["name"] == "air" for ray in rays)
    assert all(ray["depth"] == rays[ray["parent"]]["depth"] + 1 for ray in rays[1:])

    # samples lie where docs/model.md says: of four, the third is at x = 5/8
    sample = explain_json(SCENES / "bubble.json", "-p", "3,4", "--sample", 2, "-d", "reference")
    assert sample["sample"][0] == 0.625 and sample["sample"] != tree["sample"]


def device():
    """Device and reference side by side; where and why they part."""
    text, both = explain(SCENES / "bubble.json", "-p", "320,240", "--depth", 3)
    assert both["parts"] is None and "The trees agree" in text
    assert both["device"]["mantissa"] == 24 and both["device"]["name"]
    assert len(both["pairs"]) == len(both["device"]["rays"]) == len(both["reference"]["rays"])
    assert all(10 <= bits <= 24 for pair in both["pairs"] for bits in pair["bits"].values())
    assert both["device"]["nonfinite"] is None

    # more bits are asked for than floats have
    text = explain_text(SCENES / "bubble.json", "-p", "320,240", "--depth", 3, "--bits", 25)
    assert "They part first at #0" in text and "fewer than 25" in text

    pathlib.Path("far.json").write_text(FAR_BALL)
    assert explain_json("far.json", "-p", "3,2")["parts"] is None, "robust spheres part"
    text, textbook = explain("far.json", "-p", "3,2", "-m", "sphere=textbook")
    assert textbook["parts"] is not None, "a method that is wrong here agrees"
    parts = textbook["parts"]["pair"]
    assert f"They part first at #{parts}:" in text and "<──" in text
    assert parts <= 1, "the camera ray or its reflection is what goes wrong"

    pathlib.Path("beyond.json").write_text(BEYOND_FLOATS)
    text, beyond = explain("beyond.json", "-p", "0,0")
    found = beyond["device"]["nonfinite"]
    assert found == {"ray": 2, "quantity": "irradiance"}
    assert beyond["device"]["rays"][2]["irradiance"] == ["inf"] * 3
    assert beyond["reference"]["nonfinite"] is None
    assert "Not finite by the device: first the irradiance of #2 (shadow ray to light 0" in text

    # a shader of one's own is explained, too, if it still notes down what it does
    whitted = (pathlib.Path(os.environ["TURNER_SOURCE"]) / "shaders/whitted.glsl").read_text()
    assert "turn < scene.max_steps" in whitted
    pathlib.Path("own").mkdir()
    own = pathlib.Path("own/whitted.glsl")
    own.write_text(whitted.replace("turn < scene.max_steps", "turn < 3u"))
    bound = explain_json(SCENES / "bubble.json", "-p", "320,240", "--shader-dir", "own")
    ends = [ray["end"] for ray in bound["device"]["rays"]]
    assert ends == ["surface", "light", "background", "unfinished"]
    assert bound["parts"] == {"pair": 3, "why": "ends"}
    own.write_text(re.sub(r"^ *RECORD\(.*\);$", "", whitted, flags=re.M))
    said = turner("explain", SCENES / "bubble.json", "-p", "320,240", "--shader-dir", "own",
                  status=BAD_INPUT).stderr
    assert "RECORD" in said


def main():
    what = sys.argv[1]
    if what == "device":
        probe = subprocess.run([TURNER, "devices"], capture_output=True, text=True)
        if probe.returncode != 0 or "bvh         yes" not in probe.stdout:
            print("skipped:", probe.stderr.strip() or "no Vulkan device has what turner requires")
            sys.exit(77)
    with tempfile.TemporaryDirectory(prefix="turner-explain-") as folder:
        os.chdir(folder)
        SCENES.symlink_to(pathlib.Path(os.environ["TURNER_SOURCE"]) / "scenes")
        {"usage": usage, "reference": reference, "device": device}[what]()
        os.chdir("/")


main()
