"""params.py TEST…: parameters of shaders, from the command line and the scene to the picture."""

import json

from bench import SCENE, close, draw, exr, run, turner, write

EMPTY = {**SCENE, "primitives": [], "settings": {"size": [4, 3]}}
ALL = """//!PARAM level float 0.25 0 8 "red"
//!PARAM count int 3 -4 9 "green, in eighths"
//!PARAM tint color 0.5,0.25,0.125 0 2 "added"
//!PARAM on bool false "adds 4 to blue"
//!PARAM mode choice plain plain|double|triple "multiplies"
//!PARAM CONST float 1 0 3 "multiplies red"
vec3 user_background(vec3 direction)
{
    vec3 c = vec3(level * CONST, float(count) / 8.0, on ? 4.0 : 0.0) + tint;
    return mode == mode_triple ? 3.0 * c : mode == mode_double ? 2.0 * c : c;
}
"""


def color(scene, *options):
    return draw(scene, *options)[1, 1]


def values(constant=""):
    """Each type, by --set, by the scene, and both; as live ones and as const."""
    kind = "const " if constant else ""
    text = "\n".join(line.replace(" ", f" {kind}", 2).replace(f" {kind}", " ", 1)
                     if line.startswith("//!PARAM") else line for line in ALL.split("\n"))
    write("own/user/background.glsl", text.replace("CONST", "gain"))
    write("scene.json", EMPTY)
    write("set.json", {**EMPTY, "params": {"level": 1, "count": -4, "tint": [1, 0.5, 0], "on": True,
                                           "mode": "double", "gain": 2}})
    own = ["--shader-dir", "own"]
    assert close(color("scene.json", *own), (0.75, 0.625, 0.125))
    assert close(color("scene.json", *own, "--set", "level=2", "--set", "tint=#ffffff",
                       "--set", "mode=triple"), (9, 4.125, 3))
    assert close(color("set.json", *own), (6, 0, 8))
    assert close(color("set.json", *own, "--set", "on=false", "--set", "level=0"), (2, 0, 0))
    for bad in ("level=9", "level=", "count=1.5", "tint=1,2", "on=1", "mode=none", "levle=1", "x"):
        turner("render", "scene.json", "-o", "x.exr", *own, "--set", bad, status=2)
    said = turner("render", "scene.json", "-o", "x.exr", *own, "--set", "levle=1", status=2).stderr
    assert 'did you mean "level"?' in said
    write("wrong.json", {**EMPTY, "params": {"level": {"a": 1}}})
    assert "wrong.json:" in turner("render", "wrong.json", "-o", "x.exr", *own, status=3).stderr


def constants():
    values("const")


def metadata():
    """The settings in the picture say all values, so that they make the same bytes again."""
    write("own/user/background.glsl", ALL.replace("CONST", "gain"))
    write("scene.json", EMPTY)
    own = ["--shader-dir", "own"]
    turner("render", "scene.json", "-o", "a.exr", "-q", *own, "--set", "level=0.1")
    settings = json.loads(exr.read("a.exr").attributes["turner:settings"])
    assert settings["params"]["level"] == "0.1" and settings["params"]["mode"] == "plain"
    write("again.json", {**EMPTY, "params": settings["params"]})
    turner("render", "again.json", "-o", "b.exr", "-q", *own)
    assert open("a.exr", "rb").read() == open("b.exr", "rb").read(), "same settings, other bytes"
    printed = json.loads(turner("render", "again.json", "--print-settings", *own).stdout)
    assert printed["params"] == settings["params"]
    assert printed["shaders"] == settings["shaders"] and len(settings["shaders"]) == 16
    write("own/user/background.glsl", ALL.replace("CONST", "gain") + "// other\n")
    other = json.loads(turner("render", "again.json", "--print-settings", *own).stdout)
    assert other["shaders"] != settings["shaders"], "the shaders' hash does not follow the shaders"
    plain = json.loads(turner("render", "scene.json", "--print-settings").stdout)
    assert "params" not in plain and "shaders" not in plain


def everywhere():
    """A parameter of a surface counts in layers and in turner explain; one of post in post alone; a
    material is found by its name."""
    write("own/user/surface.glsl", """//!PARAM k const float 0.25 0 1 "k_d"
//!PARAM which material floor "where"
//!PARAM live float 1 0 9 "factor"
void user_surface(inout turner_gpu_material material, inout real3 ns, surface_t surface)
{
    if (surface.material == which)
        material.k_d = vec3(k * live);
}
""")
    write("own/user/post.glsl", """//!PARAM factor float 2 0 9 "of the picture"
vec3 user_post(vec3 color, vec2 position, vec2 size) { return color * factor; }
""")
    write("scene.json", SCENE)
    own = ["--shader-dir", "own", "--set", "k=0.5", "--set", "live=0.5"]
    draw("scene.json", *own, "--aov", "albedo")
    assert close([exr.read("picture.exr").channels["albedo.R"][0]], [0.25]), "albedo"
    one, three = (draw("scene.json", *own, "--set", f"factor={f}")[0, 0] for f in (1, 3))
    assert close([3 * v for v in one], three), "post"
    other = draw("scene.json", *own, "--set", "factor=1", "--set", "which=nothing")[0, 0]
    assert close(other, [2 * v for v in one]), "the floor's own k_d is 0.5"
    told = json.loads(turner("explain", "scene.json", "--pixel", "0,0", "--json", *own).stdout)
    expected = 9 * 0.25 * told["device"]["rays"][1]["n_dot_l"]
    assert close(told["device"]["radiance"], [expected] * 3), "explain"
    assert close(told["reference"]["radiance"], [2 * expected] * 3, 1e-5), "without the hook"


def listed():
    write("own/user/background.glsl", ALL.replace("CONST", "gain"))
    write("scene.json", {**EMPTY, "params": {"level": 1}})
    own = ["--shader-dir", "own"]
    rows = json.loads(turner("params", "--json", *own, "--set", "count=4", "scene.json").stdout)
    assert [r["name"] for r in rows] == ["level", "count", "tint", "on", "mode", "gain"]
    level, count, tint, on, mode, _ = rows
    assert level == {"name": "level", "type": "float", "const": False, "default": "0.25",
                     "value": "1", "least": 0, "most": 8, "text": "red",
                     "file": "own/user/background.glsl", "line": 1}
    assert count["value"] == "4" and tint["value"] == "0.5,0.25,0.125" and tint["most"] == 2
    assert mode["choices"] == ["plain", "double", "triple"] and on["value"] == "false"
    text = turner("params", *own, "scene.json").stdout
    assert "level = 1   (float 0 … 8, default 0.25)" in text and "red" in text
    write("plain.json", EMPTY)
    assert "declare no parameters" in turner("params", "plain.json").stdout
    turner("params", "scene.json", status=2)  # it gives a value to one that is not there
    turner("params", *own, "--set", "count=99", "scene.json", status=2)
    broken = ALL.replace("0.25 0 8", "0.25 0 x")
    write("own/user/background.glsl", broken)
    said = turner("params", *own, "scene.json", status=3).stderr
    assert "own/user/background.glsl:1:29: " in said, said


run({t.__name__: t for t in (values, constants, metadata, everywhere, listed)})
