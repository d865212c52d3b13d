"""compare.py TEST…: turner compare-shaders, on pictures whose difference is known."""

import json

from bench import SCENE, run, turner, write

EMPTY = {**SCENE, "primitives": [], "settings": {"size": [8, 6]}}


def compare(*arguments):
    return json.loads(turner("compare-shaders", *arguments, "--json", "-q").stdout)


def differences():
    write("scene.json", EMPTY)
    write("one/user/background.glsl", "vec3 user_background(vec3 d) { return vec3(1); }\n")
    write("two/user/background.glsl", '//!PARAM level float 3 0 9 "x"\n'
          "vec3 user_background(vec3 d) { return vec3(level); }\n")
    found = compare("scene.json", "one", "two", "--runs", "3")
    assert found["difference"]["rmse"] == 2 and found["difference"]["largest"] == 2
    assert found["difference"]["pixels_over"] == found["difference"]["pixels"] == 48
    assert len(found["a"]["runs"]) == 3 and found["ratio"] > 0
    assert found["a"]["rays"] == {"camera": 48, "reflected": 0, "refracted": 0, "shadow": 0}
    assert "error" not in found["a"], "the reference knows no hooks"
    assert found["a"]["hooks"] == "one/user/background.glsl"
    assert found["b"]["settings"]["params"] == {"level": "3"}
    assert "params" not in found["a"]["settings"]
    found = compare("scene.json", "two", "two", "--runs", "1", "--set-a", "level=1", "--set-b",
                    "level=6")
    assert found["difference"]["rmse"] == 5
    found = compare("scene.json", "one", "two", "--runs", "1", "--set", "level=1")
    assert found["difference"]["rmse"] == 0, "a value is for the side that has the parameter"
    turner("compare-shaders", "scene.json", "one", "two", "--set", "lovel=1", status=2)
    turner("compare-shaders", "scene.json", "one", status=2)
    turner("compare-shaders", "scene.json", "one", "nowhere", status=3)
    write("two/user/background.glsl", "vec3 user_background(vec3 d) { return 1 }\n")
    turner("compare-shaders", "scene.json", "one", "two", status=3)


def errors():
    """Of turner's own shaders against the reference, and of a mistake in them that is no hook."""
    write("scene.json", SCENE)
    write("own/fresnel.glsl", (turner_file("fresnel.glsl")) + "// the same\n")
    found = compare("scene.json", "-", "own", "--runs", "1", "--heatmap", "h.png")
    for side in "ab":
        assert found[side]["error"]["rmse"] < 1e-6 * 9, found[side]["error"]
    assert found["difference"]["pixels_over"] == 0
    assert open("h.png", "rb").read(4) == b"\x89PNG"
    own = turner_file("light.glsl").replace("float cos_light = min(", "float cos_light = 2.0 * min(")
    write("own/light.glsl", own)
    found = compare("scene.json", "-", "own", "--runs", "1")
    assert found["b"]["error"]["rmse"] > 1 > found["a"]["error"]["rmse"]
    assert "error" not in compare("scene.json", "-", "own", "--runs", "1", "--no-reference")["a"]
    text = turner("compare-shaders", "scene.json", "-", "-", "--runs", "2", "-q").stdout
    assert "The pictures are the same." in text and "ms a picture" in text


def turner_file(name):
    from bench import SOURCE
    return (SOURCE / "shaders" / name).read_text()


run({t.__name__: t for t in (differences, errors)})
