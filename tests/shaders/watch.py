"""watch.py TEST…: turner render --watch: draws again at each save, says what is wrong, goes on."""

import os
import pathlib
import shutil
import signal
import subprocess
import time

from bench import SCENE, TURNER, exr, run, turner, write

EMPTY = {**SCENE, "primitives": [], "settings": {"size": [8, 8]}}


class Watching:
    """turner render --watch, and what it says."""

    def __init__(self, *arguments):
        self.log = open("log", "w+")
        self.process = subprocess.Popen([TURNER, "render", *arguments, "--watch"],
                                        stdout=self.log, stderr=self.log)

    def wait(self, what, there):
        end = time.monotonic() + 60
        while not there():
            assert self.process.poll() is None, f"it ended: {self.said()}"
            assert time.monotonic() < end, f"{what} does not come: {self.said()}"
            time.sleep(0.02)

    def said(self):
        return pathlib.Path("log").read_text()

    def shows(self, red, picture="p.exr"):
        def there():
            return os.path.exists(picture) and exr.read(picture).channels["R"][0] == red
        self.wait(f"a picture of {red}", there)

    def says(self, words, times=1):
        self.wait(f"\"{words}\"", lambda: self.said().count(words) >= times)

    def end(self, number=signal.SIGINT):
        self.process.send_signal(number)
        status = self.process.wait(timeout=20)
        assert status == 128 + number, f"status {status}"
        left = [p.name for p in pathlib.Path(".").iterdir() if p.name.startswith(".")]
        assert not left, f"left behind: {left}"
        assert "validation:" not in self.said(), self.said()


def hook(value, folder="own"):
    return f"vec3 user_background(vec3 d) {{ return vec3({value}); }}\n"


def shaders():
    write("scene.json", EMPTY)
    own = pathlib.Path("own/user/background.glsl")
    write(own, hook(1))
    job = Watching("scene.json", "-o", "p.exr", "--shader-dir", "own")
    job.shows(1)
    write(own, hook(2))
    job.shows(2)
    write(own, hook("none"))
    job.says("own/user/background.glsl:1:44: 'none' : undeclared identifier")
    job.shows(2)  # the last good one
    write("aside", hook(3))
    os.rename("aside", own)  # as many editors save
    job.shows(3)
    own.unlink()
    job.shows(0)
    write(own, '#include "more.glsl"\n' + hook("MORE"))
    job.says('"more.glsl" is neither in')
    write("own/more.glsl", "#define MORE 5\n")
    job.shows(5)
    write("own/more.glsl", "#define MORE 6\n")
    job.shows(6)
    with own.open("w") as file:  # written in two halves
        file.write(hook(7)[:20])
        file.flush()
        time.sleep(0.2)
        file.write(hook(7)[20:])
    job.shows(7)
    shutil.rmtree("own")
    job.says("shader folder own: No such file or directory")
    write(own, hook(8))
    job.shows(8)
    write(own, "//!PARAM x float 1 2 3 \"t\"\n" + hook("x"))
    job.says("own/user/background.glsl:1:18:")
    write(own, "//!PARAM x float 2 1 3 \"t\"\n" + hook("x"))
    job.shows(2)
    job.end()


def scene():
    write("scene.json", {**EMPTY, "background": 1})
    job = Watching("scene.json", "-o", "p.exr")
    job.shows(1)
    write("scene.json", {**EMPTY, "background": 2})
    job.shows(2)
    write("scene.json", "{")
    job.says("scene.json:1:2: ")
    pathlib.Path("scene.json").unlink()
    job.says("scene.json: cannot be opened")
    write("scene.json", {**EMPTY, "background": 3})
    job.shows(3)
    write("shaders/user/background.glsl", hook(4))  # a folder that was not there
    job.shows(4)
    shutil.rmtree("shaders")
    job.shows(3)

    mesh = {**EMPTY, "camera": {"from": [0.2, 0.2, 1], "at": [0.2, 0.2, 0]},
            "settings": {"size": [2, 2]}, "background": 9,
            "materials": {"light": {"k_e": 7}},
            "primitives": [{"type": "mesh", "file": "m.obj", "material": "light"}]}
    write("scene.json", mesh)
    job.says("m.obj")  # it is missing
    write("m.obj", "v -9 -9 0\nv 9 -9 0\nv 0 9 0\nf 1 2 3\n")
    job.shows(7)
    write("m.obj", "v -9 -9 0\nv -8 -9 0\nv -8.5 -8 0\nf 1 2 3\n")
    job.shows(9)
    job.end(signal.SIGTERM)


def hard():
    """What no editing mends ends it."""
    write("scene.json", EMPTY)
    turner("render", "scene.json", "-o", "p.exr", "--watch", "--device", "nonesuch", status=2)
    turner("render", "scene.json", "--watch", "-o", "nowhere/p.exr", status=5)


run({t.__name__: t for t in (shaders, scene, hard)})
