"""check.py TEST…: turner check of shaders: places, editors' format, templates. No device."""

import pathlib
import re

from bench import SOURCE, run, turner, write

HOOKS = ("surface", "brdf", "background", "light", "post")


def templates():
    """Each hook's template compiles under any name, and is turner's own file."""
    for hook in HOOKS:
        text = turner("check", "--template", hook).stdout
        assert text == (SOURCE / f"shaders/user/{hook}.glsl").read_text()
        write("my.glsl", text)
        said = turner("check", "my.glsl").stdout
        assert f"takes the place of user/{hook}.glsl" in said, said
    turner("check", "--template", "none", status=2)


def examples():
    files = sorted((SOURCE / "shaders/examples").glob("*/user/*.glsl"))
    assert len(files) == 3
    turner("check", "-q", *files)


def places(path="my.glsl", message=None, body=None, more=()):
    """What is said of `body`, as editors read it: file, line and column, then the text."""
    for file, text in ((path, body), *more):
        write(file, text)
    lines = turner("check", path, status=3).stderr.splitlines()
    found = re.fullmatch(r"([^:]+):(\d+):(\d+): (.+)", lines[0])
    assert found, f"no place an editor finds: {lines[0]}"
    assert message in found[4], lines[0]
    return f"{found[1]}:{found[2]}:{found[3]}", lines


def errors():
    head = "vec3 user_brdf(turner_gpu_material material, real3 N, real3 V, real3 L)\n{\n"
    at, lines = places(body=head + "    return material.kd;\n}\n", message="no such field in structure")
    assert at == "my.glsl:3:21" or at == "my.glsl:3:5", at
    assert lines[1] == "    return material.kd;"
    at, _ = places(body=head + "    vec3 f = material.k_d\n    return f;\n}\n",
                   message="syntax error")
    assert at.startswith("my.glsl:4:"), at
    at, lines = places(body=head + "    float c = dot(N, L);\n    return vec3(c);\n}\n",
                       message="cannot convert")
    assert at == "my.glsl:3:13" and "precision=f64" in lines[-1], (at, lines)
    at, _ = places(body='#include "lib/own.glsl"\n' + head + "    return own();\n}\n",
                   more=[("lib/own.glsl", "\nvec3 own()\n{\n    return\tgone;\n}\n")],
                   message="'gone' : undeclared identifier")
    assert at == "./lib/own.glsl:4:12", at
    at, _ = places(body=head + "    return vec3(1);\n}\n  #include \"no.glsl\"\n",
                   message='"no.glsl" is neither')
    assert at == "my.glsl:5:3", at
    at, _ = places(body='\n//!PARAM x float 1 2 3 "t"\n' + head + "    return vec3(x);\n}\n",
                   message="from 2 to 3")
    assert at == "my.glsl:2:18", at
    at, _ = places(body="int x;\n", message="none of the functions")
    assert at == "my.glsl:1:1"
    at, _ = places(path="deep/user/light.glsl", body="arrival_t user_light() { return 1; }\n",
                   message="")
    assert at.startswith("deep/user/light.glsl:1:"), at
    turner("check", "nowhere.glsl", status=3)
    # one that is wrong does not keep the others from being checked
    write("good.glsl", "vec3 user_background(vec3 d) { return d; }\n")
    done = turner("check", "my.glsl", "good.glsl", status=3)
    assert "good.glsl: takes the place of user/background.glsl" in done.stdout


def recursion():
    """A hook's own includes, cycles and a file in the place of a file that is not a hook."""
    write("a.glsl", '#include "b.glsl"\nvec3 user_background(vec3 d) { return b(d); }\n')
    write("b.glsl", '#include "a.glsl"\nvec3 b(vec3 d) { return d; }\n')
    turner("check", "a.glsl", status=3)  # it is user/background.glsl, and comes in once more as a
    text = (SOURCE / "shaders/fresnel.glsl").read_text()
    write("own/fresnel.glsl", text)
    assert "takes the place of fresnel.glsl" in turner("check", "own/fresnel.glsl").stdout
    pathlib.Path("own/fresnel.glsl").write_text(text.replace("return", "retrun", 1))
    turner("check", "own/fresnel.glsl", status=3)


def scenes():
    """A scene's folder of shaders, and what it says of their parameters; also in turner chart."""
    scene = {"version": 1, "camera": {"from": [0, 0, 5], "at": [0, 0, 0]}}
    write("scene.json", scene)
    turner("check", "scene.json")
    write("shaders/user/post.glsl", "//!PARAM level float 1 0 2 \"\"\n"
          "vec3 user_post(vec3 c, vec2 p, vec2 s) { return c * level; }\n")
    for params, status in (({"level": 2}, 0), ({"level": 3}, 3), ({"lewel": 2}, 3)):
        write("scene.json", {**scene, "params": params})
        turner("check", "-q", "scene.json", status=status)
    write("scene.json", {**scene, "shaders": "nowhere"})
    assert "nowhere" in turner("check", "-q", "scene.json", status=3).stderr
    write("scene.json", scene)
    said = turner("chart", "scene.json", "--list", "--set", "level=0.5").stderr
    assert "knows nothing of shaders/user/post.glsl; what they change counts as error" in said
    turner("chart", "scene.json", "--list", "--set", "level=5", status=2)


run({t.__name__: t for t in (templates, examples, errors, recursion, scenes)}, device=False)
