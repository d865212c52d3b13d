"""view.py NAME: one test of `turner view` as it is used; `list` names them all.

Environment: TURNER, the command. Exit status 77, and why, where it cannot be tried.
"""

import json
import math
import os
import pathlib
import random
import shutil
import signal
import subprocess
import sys
import tempfile
import time

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[2] / "tools"))
import exr  # noqa: E402
from screen import DEVICE, INTERRUPTED, OK, TURNER, USAGE, Screen, Skip, View, check_machine
from screen import ppm_pixels, render, wait_until

# A mirror, glass, a checkered floor: something in every pixel that a wrong camera would move.
SCENE = """{"version": 1, "camera": {"from": [0, 1, 5], "at": [0, 0.5, 0], "vfov": 40},
 "background": {"type": "gradient", "bottom": 0.8, "top": "#4080ff"},
 "settings": {"size": [160, 120], "depth": 5},
 "materials": {"mirror": {"k_r": 0.9}, "glass": {"k_r": 1, "k_t": 1, "index": 1.5},
  "floor": {"k_d": 0.6, "pattern": {"type": "checker", "colors": ["#d02020", "#e8c840"]}}},
 "primitives": [
  {"type": "plane", "point": [0, -0.5, 0], "normal": [0, 1, 0], "material": "floor"},
  {"type": "sphere", "center": [-0.8, 0.4, 0], "radius": 0.7, "material": "mirror"},
  {"type": "sphere", "center": [0.8, 0.4, 0.3], "radius": 0.7, "material": "glass"}],
 "lights": [{"type": "point", "position": [2, 4, 3], "intensity": 40}]}"""
SIZE = (160, 120)

tests = {}


def test(function):
    tests[function.__name__] = function
    return function


def opened(screen, *arguments):
    """A view of the scene that has come to rest; what it shows is what turner render draws."""
    wanted = ppm_pixels(render("scene.json", "wanted.ppm", *arguments))
    view = View(screen, "scene.json", "-q", *arguments).find()
    view.wait_for_picture(*wanted)
    return view


@test
def picture(screen):
    """It opens and shows the pixels of `turner render`; S writes its bytes; then it rests."""
    for settings in ([], ["--spp", "3", "--exposure", "0.5"], ["-m", "aa=adaptive:0.05,16"],
                     ["--error", "1/64"]):
        wanted = ppm_pixels(render("scene.json", "wanted.ppm", *settings))
        view = View(screen, "scene.json", "-q", "-o", "shot.exr", *settings).find()
        wait_until("the picture is not shown", lambda: screen.shown(*SIZE) == wanted[2])
        view.key("s")
        shot = pathlib.Path("shot.exr")
        wait_until("nothing was saved", shot.exists)
        assert shot.read_bytes() == render("scene.json", "same.exr", *settings), "other bytes"
        shot.unlink()
        if not settings:
            time.sleep(3)  # until it no longer says that it saved
            wait_until("it does not rest", view.rests, 20)
        view.quit()


def wait_for_frame(view, size=(64, 48)):
    view.find()
    wait_until("nothing is shown", lambda: len(set(view.screen.shown(*size))) > 20)


@test
def ends(screen):
    """By key, by the window's button, by signals; each leaves nothing behind."""
    for way in ("Escape", "q"):
        view = View(screen, "scene.json")
        wait_for_frame(view)
        view.key(way)
        view.end()
    view = View(screen, "scene.json")
    wait_for_frame(view)
    view.press_close_button()
    view.end()
    for number in (signal.SIGINT, signal.SIGTERM):
        view = View(screen, "scene.json")
        wait_for_frame(view)
        view.process.send_signal(number)
        view.end(INTERRUPTED)
    view = View(screen, "scene.json")  # before there is a window
    view.process.send_signal(signal.SIGINT)
    view.process.wait(60)
    assert view.process.returncode in (-signal.SIGINT, INTERRUPTED), "interrupted at once"
    left = sorted(path.name for path in pathlib.Path().iterdir())
    assert left == ["scene.json"], f"left behind: {left}"


@test
def display(screen):
    """No display, and one that goes away, are said in a sentence."""
    nowhere = View(screen, "scene.json", environment={"DISPLAY": ":987", "WAYLAND_DISPLAY": ""})
    _, err = nowhere.end(DEVICE)
    assert "no window can be opened" in err and "turner render" in err, "what is wrong, what to do"
    nowhere = View(screen, "scene.json", environment={"DISPLAY": "", "WAYLAND_DISPLAY": ""})
    nowhere.end(DEVICE)
    view = View(screen, "scene.json")
    wait_for_frame(view)
    screen.server.kill()
    _, err = view.end(DEVICE)
    assert err.startswith("turner: error: "), "a sentence"


@test
def resize(screen):
    """The picture follows the window, to 1×1 and back."""
    view = opened(screen)
    for width, height in ((1, 1), (300, 200), (7, 90), SIZE):
        view.xdo("windowsize", "--sync", view.window, width, height)
        wanted = ppm_pixels(render("scene.json", "wanted.ppm", "--size", f"{width}x{height}"))
        view.wait_for_picture(*wanted)
    view.xdo("windowunmap", "--sync", view.window)
    time.sleep(0.5)
    view.xdo("windowmap", "--sync", view.window)
    view.wait_for_picture(*wanted)
    view.focus()
    view.quit()


@test
def lost(screen):
    """A surface that is lost, as when the display begins anew, is made anew; the picture stays."""
    if os.environ["TURNER_SANITIZED"] == "ON":
        raise Skip("the sanitizer wants to be the first library")
    wanted = ppm_pixels(render("scene.json", "wanted.ppm"))
    for call in ("acquire", "present"):
        view = View(screen, "scene.json", "-q", environment={
            "LD_PRELOAD": os.environ["TURNER_LOSE_LIBRARY"], "TURNER_LOSE": call}).find()
        for _ in range(12):  # frames
            view.key("Tab")
            time.sleep(0.05)
        view.wait_for_picture(*wanted)
        view.key("q")
        said = view.process.communicate(timeout=60)[1]
        assert view.process.returncode == OK, said
        assert said.count("lost\n") >= 2 and said.replace("lost\n", "") == "", said


def near(a, b, tolerance=2e-5):
    return all(abs(x - y) <= tolerance for x, y in zip(a, b, strict=True))


def minus(a, b):
    return [x - y for x, y in zip(a, b)]


def length(v):
    return math.sqrt(sum(x * x for x in v))


def about_y(v, angle):
    """Turned, from above against the clock."""
    x, y, z = v
    c, s = math.cos(angle), math.sin(angle)
    return [c * x + s * z, y, c * z - s * x]


@test
def camera(screen):
    """Mouse and keys move the camera as docs/view.md says."""
    view = opened(screen)
    start = {"from": [0, 1, 5], "at": [0, 0.5, 0], "up": [0, 1, 0], "vfov": 40}
    assert view.camera() == start, "the scene's camera"
    back = minus(start["from"], start["at"])

    view.drag(1, 100, 60, -40, 0)  # a quarter of the window is an eighth around
    now = view.camera()
    assert now["at"] == start["at"] and now["vfov"] == 40, "orbit"
    assert near(minus(now["from"], now["at"]), about_y(back, math.pi / 4)), f"orbit: {now}"
    view.key("Home")
    assert view.camera() == start, "Home"

    view.drag(1, 80, 30, 0, 30)  # down: over the top, by a quarter of half around
    now = minus(view.camera()["from"], start["at"])
    angle = math.atan2(back[1], back[2]) + math.pi / 4
    assert near(now, [0, length(back) * math.sin(angle), length(back) * math.cos(angle)]), "raise"
    view.key("Home")

    view.xdo("click", 4)
    now = minus(view.camera()["from"], start["at"])
    assert near(now, [0.9 * x for x in back]), "the wheel"
    view.key("Home")

    for button, held in ((2, ()), (1, ("shift",))):
        view.drag(button, 60, 60, 30, 0, *held)
        pixel = 2 * math.tan(math.radians(20)) * length(back) / SIZE[1]
        now = view.camera()
        assert near(now["from"], [-30 * pixel, 1, 5]), f"pan: {now}"
        assert near(now["at"], [-30 * pixel, 0.5, 0]), f"pan: {now}"
        view.key("Home")

    view.drag(3, 60, 60, 30, 0)
    now = view.camera()
    turned = about_y(minus(start["at"], start["from"]), math.radians(40) * 30 / SIZE[1])
    assert now["from"] == start["from"] and near(minus(now["at"], now["from"]), turned), "turn"
    view.key("Home")

    forward = [-x / length(back) for x in back]
    for key, way in (("Up", forward), ("Left", [-1, 0, 0])):
        view.xdo("keydown", key)
        wait_until("it does not fly", lambda: differs(view, "from", start["from"]))
        time.sleep(0.1)
        view.xdo("keyup", key)
        now = view.camera()
        step = minus(now["from"], start["from"])
        assert length(step) > 0.01 and near(minus(now["at"], start["at"]), step), f"fly: {now}"
        assert near([x / length(step) for x in step], way, 1e-3), f"fly: {now}"
        view.key("Home")

    for patience in (5, 5, 60):  # to a busy machine the clicks may seem to be too far apart
        view.xdo("mousemove", 50, 60, "click", "--repeat", 2, "--delay", 60, 1)  # the mirror
        try:
            at = wait_until("nothing was looked at", lambda: differs(view, "at", start["at"]),
                            patience)
            break
        except AssertionError:
            if patience == 60:
                raise
    assert abs(length(minus(at, [-0.8, 0.4, 0])) - 0.7) < 1e-4, f"not on the sphere: {at}"
    view.quit()


def differs(view, key, value):
    now = view.camera()[key]
    return now if now != value else None


GRAB = bytes((217, 168, 77))  # of a slider


def sliders(screen, width, height):
    """The middles of the sliders' grabs, from the top down."""
    found, pixels = [], screen.shown(width, height)
    for y in range(height):
        row = pixels[3 * width * y:3 * width * (y + 1)]
        xs = [x for x in range(width) if row[3 * x:3 * x + 3] == GRAB]
        if len(xs) > 4:
            if found and y - found[-1][2] < 4:
                found[-1][2] = y
            else:
                found.append([sum(xs) // len(xs), y, y])
    return [(x, (top + bottom) // 2) for x, top, bottom in found]


def right_part(pixels, width, height):
    """Beside the panel."""
    return [pixels[3 * (width * y + 400):3 * width * (y + 1)] for y in range(height)]


@test
def panel(screen):
    """The panel opens over the picture, and a slider changes it; so does what is shown."""
    size = (640, 480)
    view = View(screen, "scene.json", "-q", "--size", "640x480").find()
    def wanted(*settings):
        return right_part(ppm_pixels(render("scene.json", "wanted.ppm", "--size", "640x480",
                                            *settings))[2], *size)
    def shown():
        return right_part(screen.shown(*size), *size)
    deep, flat = wanted(), wanted("--depth", "0")
    wait_until("no picture", lambda: shown() == deep)
    bare = screen.shown(*size)
    view.key("Tab")
    wait_until("no panel", lambda: len(sliders(screen, *size)) >= 4)
    def first():
        return wait_until("no slider", lambda: sliders(screen, *size))[0]
    what = "the slider changes nothing"
    view.drag_until(what, lambda: shown() == flat, 1, first, -300, 0)
    view.drag_until(what, lambda: shown() != flat, 1, first, 300, 0)
    view.key("Tab")
    view.key("Home")
    view.quit()
    view = View(screen, "scene.json", "-q", "--size", "640x480", "--show", "normal").find()
    wait_until("no normals", lambda: bytes((128, 255, 128)) in b"".join(shown()))  # the floor
    view.key("shift+v")
    wait_until("not the picture", lambda: screen.shown(*size) == bare)
    view.quit()


@test
def params(screen):
    """Parameters of shaders have sliders: live ones, and const ones that make another kernel."""
    size = (640, 480)
    hook = """//!PARAM level float 0.25 0 4 "red"
//!PARAM count const int 3 -4 9 "green, in tenths"
//!PARAM blue float %s 0 1 "blue"
vec3 user_background(vec3 direction)
{
    return vec3(level / 4.0, float(count) / 10.0, blue);
}
"""
    text = SCENE.replace('"settings"', '"params": {"level": 1}, "settings"')
    pathlib.Path("scene.json").write_text(text)
    pathlib.Path("shaders/user").mkdir(parents=True)
    pathlib.Path("shaders/user/background.glsl").write_text(hook % "0.5")
    view = View(screen, "scene.json", "-q", "--size", "640x480", "-o", "shot.png", "--set",
                "level=2").find()
    def shows(*settings):
        wanted = right_part(ppm_pixels(render("scene.json", "wanted.ppm", "--size", "640x480",
                                              *settings))[2], *size)
        return lambda: right_part(screen.shown(*size), *size) == wanted
    wait_until("no picture", shows("--set", "level=2"))
    view.key("Tab")
    def slider(number):
        return lambda: wait_until("no slider", lambda: sliders(screen, *size)[number:])[0]
    wait_until("no sliders", lambda: len(sliders(screen, *size)) >= 3)
    view.drag_until("no live one", shows("--set", "level=4"), 1, slider(0), 200, 0)
    view.drag_until("no const one", shows("--set", "level=4", "--set", "count=9"), 1, slider(1),
                    200, 0)
    pathlib.Path("shaders/user/background.glsl").write_text(hook % "0.75")
    chosen = ("--set", "level=4", "--set", "count=9")
    wait_until("not the new default", shows(*chosen))
    view.key("s")
    wait_until("nothing was saved", pathlib.Path("shot.png").exists)
    assert pathlib.Path("shot.png").read_bytes() == render(
        "scene.json", "same.png", "--size", "640x480", *chosen), "other values in it"
    pathlib.Path("scene.json").write_text(text.replace('"level": 1', '"level": 3'))
    wait_until("not what the command line says", shows("--set", "level=2"))
    view.quit()


@test
def against(screen):
    """Two sides and a divider, how they differ, and the figures of both."""
    size, fps = (640, 480), ["--size", "640x480"]
    def part(pixels, left, right):  # below the figures
        return [pixels[3 * (640 * y + left):3 * (640 * y + right)] for y in range(200, 440)]
    def wanted(*settings, scene="scene.json"):
        return ppm_pixels(render(scene, "wanted.ppm", *fps, *settings))[2]
    def shows(what, left, right, split):
        view.xdo("mousemove", 639, 479)  # the pointer is drawn, too
        wait_until(what, lambda: part(screen.shown(*size), 0, split - 8) ==
                   part(left, 0, split - 8) and
                   part(screen.shown(*size), split + 8, 640) == part(right, split + 8, 640))
    deep, flat = wanted(), wanted("--depth", "1")
    view = View(screen, "scene.json", "-q", *fps, "--against", "depth=1", "--stats",
                "stats.json").find()
    shows("both sides", deep, flat, 320)
    view.drag(1, 320, 300, -160, 0)
    shows("another split", deep, flat, 160)
    view.key("x")
    wait_until("all A", lambda: part(screen.shown(*size), 0, 630) == part(deep, 0, 630))
    view.key("x")
    wait_until("all B", lambda: part(screen.shown(*size), 10, 640) == part(flat, 10, 640))
    view.key("x", "h")
    subprocess.run([TURNER, "compare-shaders", "scene.json", "-", "-", "--method-b", "depth=1",
                    "--heatmap", "heat.ppm", "--no-reference", "--runs", "1", "-q", *fps],
                   check=True, capture_output=True, timeout=120)
    heat = ppm_pixels(pathlib.Path("heat.ppm").read_bytes())[2]
    wait_until("the heat map", lambda: part(screen.shown(*size), 0, 640) == part(heat, 0, 640))
    view.key("h")
    shows("the middle again", deep, flat, 320)
    view.drag(1, 200, 400, 30, 10)
    moved = json.loads(SCENE) | {"camera": view.camera()}
    pathlib.Path("moved.json").write_text(json.dumps(moved))
    shows("both moved", wanted(scene="moved.json"), wanted("--depth", "1", scene="moved.json"), 320)
    wait_until("it does not rest", view.rests)  # both are measured
    view.quit()
    stats = json.loads(pathlib.Path("stats.json").read_text())
    assert stats["a"]["error"]["rmse"] < 1e-3 < 0.05 < stats["b"]["error"]["rmse"], stats
    assert stats["difference"]["rmse"] > 0.05, stats
    assert stats["a"]["rays"]["refracted"] > stats["b"]["rays"]["refracted"] > 0, stats

    hook = "vec3 user_background(vec3 direction)\n{\n    return vec3(%s);\n}\n"
    shader = pathlib.Path("own/user/background.glsl")
    shader.parent.mkdir(parents=True)
    shader.write_text(hook % "0.2, 0.7, 0.3")
    green = wanted("--shader-dir", "own")
    view = View(screen, "scene.json", "-q", *fps, "--against", "own").find()
    shows("its shaders", deep, green, 320)
    shader.write_text(hook % "0.7, 0.2")
    wait_until("the message", lambda: screen.shown(*size)[3 * 640 * 440:] != deep[3 * 640 * 440:])
    shader.write_text(hook % "0.7, 0.2, 0.3")
    shows("mended", deep, wanted("--shader-dir", "own"), 320)
    view.quit()
    for wrong in ("nothing", "deep=1", "depth=x"):
        View(screen, "scene.json", "--against", wrong).end(USAGE)


def heat(share):
    """The colours of turner compare --heatmap: black, red, yellow, white."""
    return [min(max(3 * share - i, 0), 1) for i in range(3)]


@test
def shown(screen):
    """What is shown of the pixels has the numbers that turner render --aov writes."""
    names = ("normal", "depth", "id", "rays", "recursion", "pruned", "error", "nonfinite")
    render("scene.json", "layers.exr", "--aov", ",".join(names), "--depth", "2")
    layers = exr.read("layers.exr").channels
    finite = [z for z in layers["depth.Z"] if math.isfinite(z)]
    near, far = min(finite), max(finite)
    most = {name: max(layers[name + ".X"]) or 1 for name in names[2:]}

    def wanted(name, i):
        if name == "normal":
            n = [layers[f"normal.{c}"][i] for c in "XYZ"]
            return [0.5 + 0.5 * x for x in n] if any(n) else [0, 0, 0]
        if name == "depth":
            z = layers["depth.Z"][i]
            return [1 - 0.9 * (z - near) / (far - near) if math.isfinite(z) else 0] * 3
        return heat(layers[name + ".X"][i] / most[name])

    view = View(screen, "scene.json", "-q", "--depth", "2", "-o", "shot.ppm", "--show",
                "normal").find()
    for name in names:
        shot = pathlib.Path("shot.ppm")
        view.key("s")
        wait_until("nothing was saved", shot.exists)
        width, height, rgb = ppm_pixels(shot.read_bytes())
        shot.unlink()
        pixels = [tuple(rgb[3 * i:3 * i + 3]) for i in range(width * height)]
        if name == "id":
            pairs = set(zip(layers["id.X"], pixels))
            assert len(pairs) == len(set(layers["id.X"])) > 3, "a colour for each"
        elif name == "nonfinite":
            assert (255, 0, 255) not in pixels and len(set(pixels)) > 20, "a grey picture"
        else:
            for i, pixel in enumerate(pixels):
                assert near_bytes(pixel, wanted(name, i)), f"{name} {i}: {pixel} {wanted(name, i)}"
        view.key("v")
    view.key("s")  # the difference to the reference
    wait_until("nothing was saved", pathlib.Path("shot.ppm").exists)
    assert b"\xff\xff\xff" in ppm_pixels(pathlib.Path("shot.ppm").read_bytes())[2], "the largest"
    view.key("v")
    view.wait_for_picture(*ppm_pixels(render("scene.json", "wanted.ppm", "--depth", "2")))
    view.quit()


def near_bytes(pixel, wanted):
    return all(abs(p - 255 * w) <= 1 for p, w in zip(pixel, wanted, strict=True))


@test
def edits(screen):
    """Edits in any order, half of them broken, many before the last was drawn: never a black window,
    and what is shown in the end is what the files say."""
    dice = random.Random(4)
    hook = pathlib.Path("shaders/user/background.glsl")
    hook.parent.mkdir(parents=True)
    good = "vec3 user_background(vec3 direction)\n{\n    return vec3(%.2f, 0.5, 0.8);\n}\n"
    broken = ["vec3 user_background(vec3 d) { return vec3(1.0) }\n", "#include \"none.glsl\"\n", "",
              "/* never ended", "//!PARAM x float 3 0 2 \"\"\n", "\x01 } } ;\n"]
    view = opened(screen)
    for number in range(60):
        if dice.random() < 0.4:
            text = SCENE.replace("0.6", f"{dice.randint(3, 9) / 10}", 1)
            bad = dice.random() < 0.5
            pathlib.Path("scene.json").write_text(text[:dice.randrange(len(text))] if bad else text)
        elif dice.random() < 0.1:
            hook.unlink(missing_ok=True)
        else:
            bad = dice.random() < 0.5
            hook.write_text(dice.choice(broken) if bad else good % dice.choice((0.1, 0.4, 0.7)))
        time.sleep(dice.choice((0, 0.02, 0.2)))
        assert view.process.poll() is None, "it ended"
        assert len(set(screen.shown(*SIZE))) > 20, f"a black window after edit {number}"
    pathlib.Path("scene.json").write_text(SCENE.replace("0.6", "0.9", 1))
    hook.write_text(good % 0.25)
    wanted = ppm_pixels(render("scene.json", "wanted.ppm"))[2]
    wait_until("not what the files say", lambda: screen.shown(*SIZE) == wanted)  # nor a message
    view.quit()


@test
def soon(screen):
    """A saved hook is seen before its kernel is there; the picture follows."""
    hook = pathlib.Path("shaders/user/background.glsl")
    hook.parent.mkdir(parents=True)
    text = "vec3 user_background(vec3 direction)\n{\n    return vec3(%s);\n}\n"
    hook.write_text(text % "0.9, 0.5, 0.2")
    view = View(screen, "scene.json", "-q", "--stats", "stats.json").find()
    for color in ("0.2, 0.7, 0.3", "0.3, 0.2, 0.8"):
        view.wait_for_picture(*ppm_pixels(render("scene.json", "wanted.ppm")))
        wait_until("it does not rest", view.rests)
        hook.write_text(text % color)
    view.wait_for_picture(*ppm_pixels(render("scene.json", "wanted.ppm")))
    view.quit()
    changes = json.loads(pathlib.Path("stats.json").read_text())["changes"]
    assert changes["previewed"] == 2 and changes["built"] == 1, changes


@test
def follows(screen):
    """While a saved hook's kernel is made, compiled by the driver too, the picture goes on moving."""
    hook = pathlib.Path("shaders/user/background.glsl")
    hook.parent.mkdir(parents=True)
    text = "vec3 user_background(vec3 direction)\n{\n    return vec3(%.9f);\n}\n"
    hook.write_text(text % 0.2)
    view = View(screen, "scene.json", "-q", "--spin", "2").find()
    changes = []  # seconds at which the display showed something else

    def moves():
        now = screen.shown(*SIZE)
        if not changes or now != changes[-1][1]:
            changes.append((time.monotonic(), now))
        return len(changes)

    wait_until("it does not move", lambda: moves() > 20)
    gray = changes[-1][1][:3]
    del changes[:-1]
    start = changes[0][0]
    hook.write_text(text % (0.8 + 1e-3 * random.random()))  # no cache has it
    wait_until("the saved hook is not seen", lambda: moves() and changes[-1][1][:3] != gray)
    times = [when for when, _ in changes]
    took = times[-1] - start
    pause = max(b - a for a, b in zip(times, times[1:]))
    print(f"{len(times)} frames in {took:.2f} s, at most {pause:.2f} s apart")
    assert len(times) > 5 and pause < took / 4, "it stood still meanwhile"
    view.quit()


@test
def rays(screen):
    """Ctrl+click lists what turner explain lists; a picture that moves takes no more memory."""
    view = opened(screen)
    view.xdo("keydown", "ctrl", "mousemove", 50, 60, "click", 1, "keyup", "ctrl")
    wanted = subprocess.run([TURNER, "explain", "scene.json", "--pixel", "50,60"],
                            capture_output=True, text=True, timeout=120, check=True).stdout
    lines = wanted.splitlines(keepends=True)
    assert [view.line() for _ in lines] == lines, "another list"
    view.key("Escape")  # closes the list
    view.quit()


@test
def soak(screen):
    """Two thousand frames on the move take no more memory than the first few hundred."""
    for seconds in (6, 15, 40, 120):  # the last for machines that are busy
        view = View(screen, "scene.json", "-q", "--size", "64x48", "--spin", "2", "--stats",
                    "stats.json")
        wait_for_frame(view)
        time.sleep(2)
        before = view.memory()
        time.sleep(seconds)
        after = view.memory()
        view.quit()
        frames = json.loads(pathlib.Path("stats.json").read_text())["moving"]["frames"]
        print(f"{frames} frames, {(after - before) / 1024:.0f} KiB more")
        assert after - before < 4 << 20, f"{after - before} bytes more"
        if frames >= 2000:
            return
    raise Skip("2000 frames take too long here")


@test
def files(screen):
    """Saving the scene or a shader shows it; a broken one keeps the picture and says what is wrong."""
    view = opened(screen, "--size", "640x480")
    size = (640, 480)
    def upper(pixels):  # above what is said of a broken file
        return pixels[:3 * 640 * 240]
    def seen(what):
        wanted = upper(ppm_pixels(render("scene.json", "wanted.ppm", "--size", "640x480"))[2])
        wait_until(what, lambda: upper(screen.shown(*size)) == wanted)
        return wanted
    def save(name, text):
        path = pathlib.Path(name)
        path.parent.mkdir(parents=True, exist_ok=True)
        aside = pathlib.Path(name + ".new")  # as editors do
        aside.write_text(text)
        aside.rename(path)
    seen("the picture")
    colour = SCENE.replace("#d02020", "#20d020")
    save("scene.json", colour)
    seen("another colour")
    moved = colour.replace("[-0.8, 0.4, 0]", "[-0.9, 0.5, 0]")
    save("scene.json", moved)
    good = seen("a sphere that moved")
    save("scene.json", moved.replace("sphere", "spere", 1))
    wait_until("the message", lambda: screen.shown(*size)[3 * 640 * 400:] !=
               ppm_pixels(pathlib.Path("wanted.ppm").read_bytes())[2][3 * 640 * 400:])
    assert upper(screen.shown(*size)) == good, "the picture stays"
    save("scene.json", moved)
    wait_until("no message", lambda: screen.shown(*size) ==
               ppm_pixels(pathlib.Path("wanted.ppm").read_bytes())[2])
    save("scene.json", moved.replace("[0, 1, 5]", "[1, 1, 5]"))
    seen("another camera")

    hook = "vec3 user_background(vec3 direction)\n{\n    return vec3(%s);\n}\n"
    save("shaders/user/background.glsl", hook % "0.2, 0.7, 0.3")
    green = seen("a background of one's own")
    save("shaders/user/background.glsl", hook % "0.2, 0.7, ")
    wait_until("the message", lambda: screen.shown(*size)[3 * 640 * 400:] !=
               ppm_pixels(pathlib.Path("wanted.ppm").read_bytes())[2][3 * 640 * 400:])
    assert upper(screen.shown(*size)) == green, "the picture stays"
    save("shaders/user/background.glsl", hook % "0.7, 0.2, 0.3")
    seen("it is mended")
    view.quit()


@test
def rebuilt(screen):
    """A saved scene has only that made anew which changed."""
    def save(change):
        change(scene)
        aside = pathlib.Path("scene.new")
        aside.write_text(json.dumps(scene))
        aside.rename("scene.json")
    scene = json.loads(SCENE)
    scene["groups"] = {"ball": [{"type": "sphere", "center": [0, 0, 0], "radius": 0.2,
                                 "material": "mirror"}]}
    scene["instances"] = [{"group": "ball", "transform": [{"translate": [x, -0.3, 1.5]}]}
                          for x in (-0.5, 0, 0.5)]
    save(lambda s: None)
    def move(s):
        s["instances"][1]["transform"][0]["translate"] = [0.1, 0.3, 1.6]
    edits = [lambda s: None,
             lambda s: s["camera"].update({"from": [0.5, 1.2, 5]}),
             lambda s: s["materials"]["floor"].update(k_d=0.3),
             lambda s: s["lights"][0].update(intensity=70),
             lambda s: s["background"].update(bottom=0.3), move]
    view = View(screen, "scene.json", "-q", "--stats", "stats.json").find()
    for change in edits:
        save(change)
        view.wait_for_picture(*ppm_pixels(render("scene.json", "wanted.ppm")))
    view.quit()
    changes = json.loads(pathlib.Path("stats.json").read_text())["changes"]
    assert changes["built"] == 1 and changes["moved"] == 1 and changes["painted"] >= 5, changes
    view = View(screen, "scene.json", "-q", "--stats", "stats.json").find()
    view.wait_for_picture(*ppm_pixels(render("scene.json", "wanted.ppm")))
    save(lambda s: s["primitives"][1].update(radius=0.8))  # that takes a new one
    view.wait_for_picture(*ppm_pixels(render("scene.json", "wanted.ppm")))
    view.quit()
    changes = json.loads(pathlib.Path("stats.json").read_text())["changes"]
    assert changes["built"] == 2 and changes["moved"] == 0, changes


@test
def cameras(screen):
    """Cameras of the scene, one written into its file, a path recorded and drawn."""
    text = SCENE.replace('"background"', """"cameras": [{"at": [0,0.5,0],   "from": [5,1,0.50]},
   {"from": [0, 3, 0.5], "at": [0, 0, 0], "vfov": 70}], "background\"""", 1)
    pathlib.Path("scene.json").write_text(text)
    wanted = [ppm_pixels(render("scene.json", "wanted.ppm", "--camera", number))
              for number in range(3)]
    view = View(screen, "scene.json", "-q", "-o", "out.ppm", "--camera", "2").find()
    for key, number in (("", 2), ("0", 0), ("1", 1), ("2", 2), ("Home", 2), ("1", 1)):
        if key:
            view.key(key)
        view.wait_for_picture(*wanted[number])
    view.key("r")
    view.drag(1, 60, 60, 20, 0)
    view.key("r")
    moved = view.camera()
    view.key("shift+c")
    changed = text.replace("[5,1,0.50]", json.dumps(moved["from"]))
    wait_until("nothing was written",
               lambda: pathlib.Path("scene.json").read_text() == changed)
    view.quit()

    path = json.loads(pathlib.Path("out-path.json").read_text())
    frames = len(path["cameras"])
    assert path["rate"] == 30 and frames >= 2, "a path"
    assert path["cameras"][0]["from"] == [5, 1, 0.5] and path["cameras"][-1] == moved, "its ends"
    path["cameras"] = [path["cameras"][0], path["cameras"][-1]]
    pathlib.Path("path.json").write_text(json.dumps(path))
    pathlib.Path("scene.json").write_text(text)
    first = render("scene.json", "first.png", "--camera", "1")
    render("scene.json", "film.png", "--path", "path.json")
    assert pathlib.Path("film-0001.png").read_bytes() == first, "the first picture of the path"
    pathlib.Path("scene.json").write_text(changed)
    last = render("scene.json", "last.png", "--camera", "1")
    assert pathlib.Path("film-0002.png").read_bytes() == last, "the last picture of the path"
    assert not pathlib.Path("film-0003.png").exists(), "no more than that"


def main():
    if sys.argv[1:] == ["list"]:
        print("\n".join(tests))
        return 0
    signal.signal(signal.SIGINT, signal.default_int_handler)  # a shell's "&" has it ignored
    os.chdir(tempfile.mkdtemp(prefix="turner-view-"))
    folder = pathlib.Path().absolute()
    pathlib.Path("scene.json").write_text(SCENE)
    screen = None
    try:
        check_machine()
        screen = Screen()
        tests[sys.argv[1]](screen)
    except Skip as reason:
        print("skipped:", reason)
        return 77
    finally:
        for view in View.all:
            view.close()
        if screen:
            screen.close()
        os.chdir("/")
        shutil.rmtree(folder)
    return 0


if __name__ == "__main__":
    sys.exit(main())
