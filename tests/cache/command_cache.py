"""command_cache.py reuse | broken | key | pair | off | fastest | prebuilt | objects: pictures, whatever
the cache is like.

Environment: TURNER, the command; TURNER_SOURCE. Exit status 77 without a Vulkan device.
"""

import json
import os
import pathlib
import re
import shutil
import struct
import subprocess
import sys
import tempfile

TURNER = os.environ["TURNER"]
SHADERS = pathlib.Path(os.environ["TURNER_SOURCE"]) / "shaders"
SCENES = pathlib.Path(os.environ["TURNER_SOURCE"]) / "scenes"
SCENE = """{"version": 1, "camera": {"from": [0, 1, 5], "at": [0, 0, 0]},
 "background": 0.5, "settings": {"size": [48, 32], "depth": 4},
 "materials": {"glass": {"k_r": 1, "k_t": 1, "index": 1.5}, "grey": {"k_d": 0.5}},
 "primitives": [
  {"type": "sphere", "center": [0, 0, 0], "radius": 1, "material": "glass"},
  {"type": "box", "min": [-3, -2, -2], "max": [3, -1, 1], "material": "grey"}],
 "lights": [{"type": "point", "position": [2, 4, 3], "intensity": 30}]}"""


def render(*options, scene="scene.json", output="p.png", shaders="own", cache="cache", status=0,
           **changes):
    """The picture's bytes and what came from the cache: (source, kernel, driver)."""
    env = dict(os.environ, TURNER_CACHE_DIR=str(pathlib.Path(cache).absolute()) if cache else "")
    env.update(changes)
    for name in (output, "s.json"):
        pathlib.Path(name).unlink(missing_ok=True)
    command = ["render", scene, "-o", output, "-q", "--stats", "s.json", *options]
    if shaders:
        command += ["--shader-dir", shaders]
    done = subprocess.run([TURNER, *command], capture_output=True, text=True, timeout=120, env=env)
    print("$ turner", *options, f"=> {done.returncode}", done.stdout, done.stderr)
    if done.returncode == 4 and "no Vulkan driver" in done.stderr:
        sys.exit(77)
    assert done.returncode == status, "another exit status was expected"
    assert done.stdout == "", "something on stdout"
    if status:
        return done.stderr
    assert "cache" not in done.stderr, "a word about the cache"
    cached = json.loads(pathlib.Path("s.json").read_text())["cached"]
    return pathlib.Path(output).read_bytes(), (cached["source"], cached["kernel"],
                                                cached["driver"])


def data(png):
    """What the file holds of the picture itself."""
    at, found = 8, b""
    while at < len(png):
        size, kind = struct.unpack_from(">I4s", png, at)
        if kind == b"IDAT":
            found += png[at + 8:at + 8 + size]
        at += size + 12
    return found


def entries(cache="cache"):
    return sorted((pathlib.Path(cache) / "shaders").iterdir())


def kinds():
    """Of what is kept, and what comes from there then: drivers without shader objects keep their own."""
    found = [entry.name.split("-")[0] for entry in entries()]
    assert found in (["driver", "reduced", "spirv"], ["reduced", "spirv"])
    return found, (True, True, "driver" in found)


NONE = (False, False, False)


def reuse():
    """The second run takes all from the cache, and draws the same."""
    first, cached = render()
    assert cached == NONE, "an empty cache had something"
    kept, all_cached = kinds()
    second, cached = render()
    assert cached == all_cached, "nothing came from the cache"
    assert second == first
    # another scene needs another kernel of the same source
    text = pathlib.Path("scene.json").read_text()
    pathlib.Path("scene.json").write_text(text.replace('"k_r": 1, "k_t": 1, "index": 1.5',
                                                       '"k_d": 0.3'))
    other, cached = render()
    assert cached == (True, False, False) and other != first
    assert len(entries()) == 2 * len(kept) - 1


def broken():
    """However entries are spoilt, the picture stays and the entry is made again."""
    first, _ = render()
    whole = {entry: entry.read_bytes() for entry in entries()}
    spoilt = {
        "empty": lambda b: b"",
        "short": lambda b: b[:len(b) // 2],
        "one byte short": lambda b: b[:-1],
        "garbage": lambda b: bytes((i * 167 + 13) % 256 for i in range(len(b))),
        "another version": lambda b: bytes([b[0] ^ 1]) + b[1:],
        "last word": lambda b: b[:-4] + bytes(255 - x for x in b[-4:]),
        "zeros": lambda b: bytes(len(b)),
    }
    for what, spoil in spoilt.items():
        print("--", what)
        for entry, content in whole.items():
            entry.write_bytes(spoil(content))
        picture, cached = render()
        assert picture == first and cached == NONE, what
        assert {e: e.read_bytes() for e in entries()} == whole, f"{what}: not mended"
    # each taken for the other
    others = list(whole.values())
    for entry, other in zip(whole, others[1:] + others[:1]):
        entry.write_bytes(other)
    assert render() == (first, NONE)
    # one of them gone, then all, then the folder, then a folder in place of an entry
    for entry in whole:
        entry.unlink()
        assert render()[0] == first
    shutil.rmtree("cache/shaders")
    assert render() == (first, NONE)
    shutil.rmtree("cache")
    assert render() == (first, NONE)
    for entry in whole:
        entry.unlink()
        entry.mkdir()
        assert render()[0] == first
        entry.rmdir()
    # folders that cannot be written: read-only (not for root), a file in the way, nowhere
    for path in (pathlib.Path("cache/shaders"), pathlib.Path("cache")):
        path.chmod(0o555)
    picture, cached = render()
    assert picture == first and cached != NONE
    for path in (pathlib.Path("cache"), pathlib.Path("cache/shaders")):
        path.chmod(0o755)
    pathlib.Path("file").write_text("x")
    assert render(cache="file") == (first, NONE)
    assert render(cache="file/cache") == (first, NONE)
    assert render(cache="/proc/turner") == (first, NONE)
    assert pathlib.Path("file").read_text() == "x"


def key():
    """Sources are compared, not their names; what does not compile is never hidden."""
    first, _ = render()
    kept, all_cached = kinds()
    shutil.copytree("own", "mine")
    assert render(shaders="mine") == (first, all_cached), "the same text is the same"
    hook = pathlib.Path("mine/background.glsl")
    text = hook.read_text()
    hook.write_text(text + "// a word more\n")
    picture, cached = render(shaders="mine")
    # the picture says which shaders it is by, and is the same but for that
    assert picture != first and data(picture) == data(first)
    assert not cached[0], "changed text came from the cache"
    assert render(shaders="mine")[1] == all_cached
    hook.write_text(text + "!\n")
    said = render(shaders="mine", status=3)
    assert re.search(r"background\.glsl:\d+", said), said
    hook.write_text(text)
    assert render(shaders="mine") == (first, all_cached)
    # another kind of kernel is another entry
    count = len(entries())
    _, cached = render("-m", "sphere=f64")
    assert not cached[0] and len(entries()) == count + len(kept)


def pair():
    """Several processes fill an empty cache at once."""
    env = dict(os.environ, TURNER_CACHE_DIR=str(pathlib.Path("cache").absolute()))
    runs = [subprocess.Popen([TURNER, "render", "scene.json", "-q", "-o", f"{i}.png",
                              "--shader-dir", "own"], env=env) for i in range(4)]
    assert [run.wait(timeout=240) for run in runs] == [0] * 4
    pictures = {pathlib.Path(f"{i}.png").read_bytes() for i in range(4)}
    assert len(pictures) == 1
    _, all_cached = kinds()
    assert render() == (pictures.pop(), all_cached)


def off():
    """Switched off, nothing is read and nothing kept, not even in the home folder."""
    home = pathlib.Path("home").absolute()
    home.mkdir()
    first, _ = render()
    before = {entry: entry.read_bytes() for entry in entries()}
    assert render("--no-cache") == (first, NONE)
    assert render(cache="", HOME=str(home), XDG_CACHE_HOME="") == (first, NONE)
    assert not list(home.rglob("*turner*")), "something was kept"
    shutil.rmtree("cache")
    assert render("--no-cache") == (first, NONE)
    assert not pathlib.Path("cache").exists() and before


def devices(*options, **changes):
    env = dict(os.environ, TURNER_CACHE_DIR=str(pathlib.Path("cache").absolute()), **changes)
    done = subprocess.run([TURNER, "devices", *options], capture_output=True, text=True,
                          timeout=200, env=env)
    print("$ turner devices", *options, f"=> {done.returncode}", done.stdout, done.stderr)
    if done.returncode == 4 and "no Vulkan driver" in done.stderr:
        sys.exit(77)
    assert done.returncode == 0
    return done.stdout


def fastest():
    """What was measured is kept, and what auto takes; a broken entry is none."""
    assert "as measured" not in devices()
    said = devices("--measure")
    rates = re.findall(r"(bvh_lane|bvh_packet|ray_query) +([0-9.]+) million rays", said)
    assert "bvh_lane" in dict(rates) and all(float(rate) > 0 for _, rate in rates)
    assert [float(rate) for _, rate in rates] == sorted((float(r) for _, r in rates), reverse=True)
    assert f"auto        {rates[0][0]} from now on" in said
    assert f"auto        {rates[0][0]}, as measured" in devices()
    render()
    assert json.loads(pathlib.Path("s.json").read_text())["traversal"] == rates[0][0]
    for entry in entries():
        if entry.name.startswith("fastest"):
            entry.write_bytes(entry.read_bytes()[:-1])
    assert "as measured" not in devices()


def prebuilt():
    """turner's own shaders were compiled when it was built, to the same."""
    first, cached = render(shaders=None)
    assert cached == (True, False, False), "glslang was waited for"
    assert not [entry for entry in entries() if entry.name.startswith("spirv")]
    assert render("--no-cache", shaders=None) == (first, NONE)


def objects():
    """Every scene by a pipeline of code that is not optimised, as it is small, and by a shader object of
    code that is, then by the one that was kept: the same picture."""
    for scene in sorted(set(SCENES.glob("*.json")) - {SCENES / "schema.json"}):
        pictures = [render("--size", "64x48", scene=str(scene), output="p.exr", shaders=None, **changes)
                    for changes in ({"TURNER_MASK_EXTENSIONS": "VK_EXT_shader_object"},
                                    {"GALLIVM_PERF": ""}, {"GALLIVM_PERF": ""})]
        assert not pictures[0][1][2], "a pipeline from the cache"
        assert all(picture == pictures[0][0] for picture, _ in pictures), scene
    kept = {entry.name.split("-")[0] for entry in entries()}
    assert pictures[2][1][2] == ("driver" in kept)


def main():
    tests = {"reuse": reuse, "broken": broken, "key": key, "pair": pair, "off": off,
             "fastest": fastest, "prebuilt": prebuilt, "objects": objects}
    os.environ["LC_ALL"] = "C"
    with tempfile.TemporaryDirectory(prefix="turner-cache-") as folder:
        os.chdir(folder)
        pathlib.Path("scene.json").write_text(SCENE)
        shutil.copytree(SHADERS, "own")  # not those that were compiled when turner was built
        with open("own/render.comp", "a", encoding="utf-8") as file:
            file.write("// a word more\n")
        tests[sys.argv[1]]()
        os.chdir("/")


main()
