"""view.py NAME: one test of `turner view` as it is used; `list` names them all.

Environment: TURNER, the command. Exit status 77, and why, where it cannot be tried.
"""

import os
import pathlib
import signal
import sys
import tempfile
import time

from screen import DEVICE, INTERRUPTED, Screen, Skip, View, check_machine, ppm_pixels, render
from screen import wait_until

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
    wanted = ppm_pixels(render("scene.json", "wanted.ppm"))
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
            time.sleep(4)  # until it no longer says that it saved
            before = view.cpu()
            time.sleep(2)
            assert view.cpu() - before <= 1, f"{view.cpu() - before} ticks in 2 s at rest"
        view.quit()


def wait_for_frame(view):
    view.find()
    wait_until("nothing is shown", lambda: len(set(view.screen.shown(*SIZE))) > 20)


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
    view.xdo("windowfocus", "--sync", view.window)
    view.quit()


def main():
    if sys.argv[1:] == ["list"]:
        print("\n".join(tests))
        return 0
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
        for path in folder.iterdir():
            path.unlink()
        folder.rmdir()
    return 0


if __name__ == "__main__":
    sys.exit(main())
