"""hooks.py TEST…: the functions of shaders/user/ that a user may replace, each by one whose effect
can be computed here, and where they are looked for."""

import math
import pathlib

from bench import SCENE, SOURCE, close, draw, run, turner, write

HALF = math.tan(math.radians(15)) / 6  # of a pixel, at distance 1


def place(x, y):
    """Where the centre of a pixel meets the floor: (x, z)."""
    return 4 * HALF * (x + 0.5 - 8), 4 * HALF * (y + 0.5 - 6)


def cosine(x, z):
    return 3 / math.sqrt(x * x + z * z + 9)


def expected(picture, value):
    for (x, y), color in picture.items():
        want = value(x, y)
        assert close(color, want), f"pixel {x},{y}: {color}, not {want}"


def hook(name, body, folder="own"):
    """Only the function's body is given: the rest is as turner has it."""
    text = (SOURCE / f"shaders/user/{name}.glsl").read_text()
    start = text.index("{\n", text.index(f"user_{name}("))
    write(f"{folder}/user/{name}.glsl", text[:start] + "{\n" + body + "}\n")


def plain():
    """The scene without hooks is what the formula says, so that what follows means something."""
    write("scene.json", SCENE)
    expected(draw("scene.json"), lambda x, y: (9 * 0.5 * cosine(*place(x, y)),) * 3)


def brdf():
    write("scene.json", SCENE)
    hook("brdf", "    float c = float(dot(N, L));\n    return material.k_d * c * c + vec3(0, 1, 0);\n")
    for options in ([], ["-m", "precision=f64"], ["--traversal", "bvh_lane"]):
        expected(draw("scene.json", "--shader-dir", "own", *options),
                 lambda x, y: [9 * (0.5 * cosine(*place(x, y)) ** 2 + g) for g in (0, 1, 0)])


def surface():
    """A pattern, a highlight and a mirror that no material of the scene has, and a bump."""
    scene = {**SCENE, "background": [0.25, 0.5, 1]}
    write("scene.json", scene)
    hook("surface", "    material.k_d = fract(vec3(surface.point.x, surface.uv)); ns = vec3(0);\n")
    turner("render", "scene.json", "-o", "x.exr", "--shader-dir", "own")  # ns is no unit: no crash

    hook("surface", "    vec3 p = vec3(surface.point);\n"
                    "    material.k_d = vec3(p.x > 0.0 ? 1.0 : 0.25, p.z > 0.0 ? 1.0 : 0.5, 0.0);\n")
    expected(draw("scene.json", "--shader-dir", "own"), lambda x, y: [
        9 * cosine(*place(x, y)) * k for k in (1 if x >= 8 else 0.25, 1 if y >= 6 else 0.5, 0)])

    hook("surface", "    material.k_d = vec3(0);\n    material.k_r = vec3(0.5, 0.25, 1);\n")
    expected(draw("scene.json", "--shader-dir", "own"), lambda x, y: (0.125, 0.125, 1))

    hook("surface", "    material.k_d = vec3(0);\n    material.k_s = vec3(1);\n"
                    "    material.exponent = 1.0;\n")

    def highlight(x, y):  # R·V: R mirrors L about the normal, V is the way to the eye
        px, pz = place(x, y)
        v = math.sqrt(px * px + pz * pz + 16)
        length = math.sqrt(px * px + pz * pz + 9)
        return (9 * (12 - px * px - pz * pz) / (v * length),) * 3
    expected(draw("scene.json", "--shader-dir", "own"), highlight)

    s = math.sqrt(0.5)
    hook("surface", f"    ns = normalize(real3(1, 1, 0));\n")

    def bumped(x, y):
        px, pz = place(x, y)
        return (9 * 0.5 * s * (3 - px) / math.sqrt(px * px + pz * pz + 9),) * 3
    for options in ([], ["-m", "precision=f64"]):
        expected(draw("scene.json", "--shader-dir", "own", *options), bumped)


def background():
    write("scene.json", {**SCENE, "primitives": [], "background": 0.5})
    hook("background", "    return background(direction) * vec3(1, 2, 3) + direction * direction;\n")

    def sky(x, y):
        px, pz = place(x, y)
        n = px * px + pz * pz + 16
        return [0.5 + px * px / n, 1 + 16 / n, 1.5 + pz * pz / n]
    expected(draw("scene.json", "--shader-dir", "own"), sky)


def light():
    write("scene.json", SCENE)
    hook("light", "    arrival_t a = light_arrival(light, point);\n"
                  "    a.irradiance *= vec3(1, 0.5, float(index));\n    return a;\n")
    expected(draw("scene.json", "--shader-dir", "own"),
             lambda x, y: [9 * 0.5 * cosine(*place(x, y)) * k for k in (1, 0.5, 0)])


def post():
    write("scene.json", SCENE)
    hook("post", "    return vec3(color.r * 2.0, position / size);\n")
    for options in ([], ["--spp", "3"], ["-m", "aa=adaptive:0.1,16"]):
        before = draw("scene.json", *options)
        expected(draw("scene.json", "--shader-dir", "own", *options),
                 lambda x, y: [2 * before[x, y][0], (x + 0.5) / 16, (y + 0.5) / 12])


def folders():
    """--shader-dir, then the scene's folder, then $TURNER_SHADERS, then turner's own."""
    for folder, red in (("first", 0.1), ("sub/shaders", 0.2), ("third", 0.3), ("sub/named", 0.4)):
        hook("background", f"    return vec3({red});\n", folder)
    empty = {**SCENE, "primitives": []}
    write("sub/scene.json", empty)
    write("sub/other.json", {**empty, "shaders": "named"})
    write("missing.json", {**empty, "shaders": "nowhere"})
    write("plain.json", empty)
    third = {"TURNER_SHADERS": "third"}

    def red(scene, *options, **environment):
        import os
        os.environ.update(environment)
        value = draw(scene, *options)[0, 0][0]
        for name in environment:
            del os.environ[name]
        return value
    assert close([red("sub/scene.json", "--shader-dir", "first", **third)], [0.1])
    assert close([red("sub/scene.json", **third)], [0.2]), "shaders/ beside the scene"
    assert close([red("sub/scene.json")], [0.2])
    assert close([red("sub/other.json")], [0.4]), "the scene's \"shaders\""
    assert close([red("sub/scene.json", "--no-scene-shaders", **third)], [0.3])
    assert red("sub/scene.json", "--no-scene-shaders") == 0
    assert close([red("plain.json", **third)], [0.3])
    assert red("plain.json") == 0
    said = turner("render", "missing.json", "-o", "x.exr", status=3).stderr
    assert "nowhere" in said, said


def reference():
    """The reference knows no hooks, and says so."""
    write("scene.json", SCENE)
    hook("background", "    return vec3(1);\n")
    same = pathlib.Path("same/user/post.glsl")
    write(same, (SOURCE / "shaders/user/post.glsl").read_text())
    said = turner("render", "scene.json", "-o", "x.exr", "--device", "reference",
                  "--shader-dir", "own").stderr
    assert "knows nothing of own/user/background.glsl" in said, said
    said = turner("render", "scene.json", "-o", "x.exr", "--device", "reference",
                  "--shader-dir", "same").stderr
    assert "warning" not in said, said
    said = turner("render", "scene.json", "-o", "x.exr", "--error", "0.1", "--shader-dir",
                  "own").stderr
    assert "estimate of the error knows nothing of own/user/background.glsl" in said, said


def everything():
    """--unspecialised draws the same with hooks, too."""
    write("scene.json", SCENE)
    hook("surface", "    material.k_d.r = float(surface.uv.x);\n    material.k_r = vec3(0.1);\n")
    assert draw("scene.json", "--shader-dir", "own") == \
        draw("scene.json", "--shader-dir", "own", "--unspecialised")


def free():
    """Hooks as they come cost nothing: without them the optimised kernel has as many bytes, and draws
    the same."""
    import json
    for file, parts in (
            ("whitted.glsl", (("user_background(", "background("),)),
            ("meeting.glsl", (("user_surface(met.material, met.surface.ns, met.surface);", ""),
                              ("user_brdf(", "local_illumination("),
                              ("user_light(light_of(index), index,",
                               "light_arrival(light_of(index),")))):
        text = (SOURCE / "shaders" / file).read_text()
        for old, new in parts:
            assert text.count(old) == 1, f"{file} has changed: {old}"
            text = text.replace(old, new)
        write(f"without/{file}", text)
    for scene in ("whitted1980", "prism", "lights"):
        found = json.loads(turner("compare-shaders", SOURCE / f"scenes/{scene}.json", "without", "-",
                                  "--size", "64x48", "--runs", "1", "--no-reference", "--json",
                                  "-q").stdout)
        assert found["difference"]["pixels_over"] == 0, scene
        assert found["a"]["kernel_bytes"] == found["b"]["kernel_bytes"] > 10000, scene


run({t.__name__: t for t in (plain, brdf, surface, background, light, post, folders, reference,
                             everything, free)})
