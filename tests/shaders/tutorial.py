"""tutorial.py steps: the first section of docs/shaders.md does what it says."""

import json
import re

from bench import SOURCE, draw, run, turner, write


def steps():
    text = (SOURCE / "docs/shaders.md").read_text()
    scene = re.search(r"```json\n(.*?)```", text, re.S)[1]
    hook = re.search(r"```glsl\n(.*?)```", text, re.S)[1]
    error = re.search(r"turner says `(shaders/user/surface.glsl:[^`]*)`", text)[1]
    assert json.loads(scene) and "user_surface" in hook
    write("ball.json", scene)
    template = turner("check", "--template", "surface").stdout
    before = draw("ball.json", "--size", "64x48")
    write("shaders/user/surface.glsl", template)
    assert draw("ball.json", "--size", "64x48") == before, "the template changes the picture"

    own = template[:template.index("void user_surface")] + hook
    write("shaders/user/surface.glsl", own.replace("dark * ring;", "dark * ring"))
    said = turner("render", "ball.json", "-o", "x.exr", status=3).stderr
    assert error in said, (error, said)
    write("shaders/user/surface.glsl", own)
    rings = draw("ball.json", "--size", "64x48")
    changed = [p for p in before if before[p] != rings[p]]
    assert 300 < len(changed) < 1200, len(changed)  # the ball, not the floor
    assert all(rings[p][0] <= before[p][0] for p in changed), "rings darken"

    listed = turner("params", "ball.json").stdout
    assert "rings = 8   (float 1 … 40, default 8)" in listed, listed
    dark = draw("ball.json", "--size", "64x48", "--set", "rings=20", "--set", "dark=0.8")
    kept = json.loads(scene)
    kept["params"] = json.loads(re.search(r'`"params": ({.*?})` into the scene', text)[1])
    write("ball.json", kept)
    assert dark == draw("ball.json", "--size", "64x48") != rings


run({"steps": steps})
