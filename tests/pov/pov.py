"""pov.py command | runner | terms | scenes: the export to POV-Ray.

`terms` and `scenes` draw the same scene by POV-Ray and by the reference and compare: two programs
that share no line.
Environment: TURNER, the command; SCENES, the folder of scenes. Exit status 77 without povray.
"""

import json
import os
import pathlib
import shutil
import subprocess
import sys
import tempfile

import parts

TURNER = os.environ["TURNER"]
SCENES = pathlib.Path(os.environ["SCENES"])
OK, DIFFERS, USAGE, BAD_INPUT, DEVICE, OUTPUT = range(6)


def turner(*arguments, status=OK, env=None):
    done = subprocess.run([TURNER, *map(str, arguments)], capture_output=True, text=True,
                          timeout=300, env=env)
    if done.returncode != status:
        print("$ turner", *arguments)
        print(done.stdout[:2000], done.stderr, "=>", done.returncode, sep="")
        raise AssertionError(f"exit status {done.returncode}, not {status}")
    return done


def command():
    """What the command line lacks is said."""
    pathlib.Path("scene.json").write_text(json.dumps(parts.base()))
    turner("export", "scene.json", "--pov", "-o", "x.pov", "--size", "20x10", "--depth", "11")
    text = pathlib.Path("x.pov").read_text()
    assert "+W20 +H10" in text and "max_trace_level 12\n" in text, text
    pathlib.Path("glass.json").write_text(json.dumps(parts.base() | {
        "materials": {"thin": {"k_t": 0.8, "index": 1.1, "fresnel": "none"}},
        "primitives": [{"type": "sphere", "center": [0, 0, 0], "radius": 1, "material": "thin"}]}))
    message = turner("export", "glass.json", "--pov", "-o", "g.pov", status=BAD_INPUT).stderr
    assert "total internal reflection" in message and not pathlib.Path("g.pov").exists()
    message = turner("export", "glass.json", "--pov", "-o", "g.pov", "--anyway").stderr
    assert "total internal reflection" in message and "warning" in message, message
    assert "sphere" in pathlib.Path("g.pov").read_text()
    turner("export", "glass.json", "--pov", "-o", "g.pov", "--anyway", "--depth", "256",
           status=BAD_INPUT)
    turner("export", "glass.json", "--pov", "-o", "g.pov", "--anyway", "--run", status=USAGE)
    turner("export", "scene.json", "--pov", status=USAGE)
    turner("export", "scene.json", "-o", "x.pov", status=USAGE)
    turner("export", "--pov", "-o", "x.pov", status=USAGE)
    turner("export", "scene.json", "--pov", "-o", "x", "--run", status=USAGE)
    turner("export", "missing.json", "--pov", "-o", "x.pov", status=BAD_INPUT)
    turner("export", "scene.json", "--pov", "-o", "no/such/folder/x.pov", status=OUTPUT)
    assert "--run" in turner("export", "--help").stdout


def runner():
    """Without povray, or with one that fails, the message says so; nothing half made is read."""
    folder = pathlib.Path("programs")
    folder.mkdir()
    pathlib.Path("scene.json").write_text(json.dumps(parts.base()))
    alone = dict(os.environ, PATH=str(folder.resolve()))
    arguments = ("export", "scene.json", "--pov", "-o", "x.pov", "--run")
    message = turner(*arguments, status=DEVICE, env=alone).stderr
    assert "apt install povray" in message, message
    fake = folder / "povray"
    for body, words in (("echo no such thing; exit 3", ("exit status 3", "x.log")),
                        ("kill -9 $$", ("signal 9",)), ("exit 0", ("x.exr",)),
                        ("echo rubbish >x.exr", ("x.exr",))):
        fake.write_text("#!/bin/sh\n" + body + "\n")
        fake.chmod(0o755)
        message = turner(*arguments, status=DEVICE, env=alone).stderr
        for word in words:
            assert word in message, (body, message)
    fake.write_text("#!/bin/sh\necho no such thing; exit 3\n")
    turner(*arguments, status=DEVICE, env=alone)
    assert pathlib.Path("x.log").read_text() == "no such thing\n"
    turner("export", "scene.json", "--pov", "-o", 'a"b.pov', "--run", status=USAGE, env=alone)
    if shutil.which("povray"):
        spaced = pathlib.Path("a folder")
        spaced.mkdir()
        turner("export", "scene.json", "--pov", "-o", spaced / "my scene.pov", "--run", "--size",
               "8x6")
        assert {p.name for p in spaced.iterdir()} == {"my scene.pov", "my scene.exr",
                                                     "my scene.log"}


def difference(scene, threshold, relative, *options):
    """How POV-Ray and the reference differ, or None and why when the scene is not exported."""
    options = ("--size", "64x48", *options)
    done = subprocess.run([TURNER, "export", scene, "--pov", "-o", "povray.pov", "--run", *options],
                          capture_output=True, text=True, timeout=300)
    if done.returncode == BAD_INPUT:
        return None, done.stderr.strip()
    assert done.returncode == OK, done.stderr
    log = pathlib.Path("povray.log").read_text()
    assert "Warning" not in log, log
    turner("render", scene, "--device", "reference", "--spp", "1", "-q", "-o", "reference.exr",
           *options)
    done = subprocess.run([TURNER, "compare", "povray.exr", "reference.exr", "--json", "-",
                           "-t", str(threshold), "-r", str(relative)],
                          capture_output=True, text=True, timeout=60)
    assert done.returncode in (OK, DIFFERS), done.stderr
    return json.loads(done.stdout), None


def judge(name, figures, allowed, wrong):
    print(f"{name}: {figures['pixels_over']} of {figures['pixels']} pixels, {allowed} allowed; "
          f"largest {figures['largest']:.2g}")
    if figures["pixels_over"] > allowed:
        wrong.append(name)


def need_povray():
    if not shutil.which("povray"):
        print("skipped: povray is not installed (Debian: apt install povray)")
        sys.exit(77)


def terms():
    """The terms of the model, a few a scene. The bound is four times that of the half floats of the
    file, 2^-11 of the value: POV-Ray adds up colours of 32 bits."""
    need_povray()
    wrong = []
    for name, scene, allowed in parts.terms():
        pathlib.Path("term.json").write_text(json.dumps(scene))
        figures, why_not = difference("term.json", 1e-3, 2e-3)
        assert figures, why_not
        judge(name, figures, allowed, wrong)
    assert not wrong, wrong


# Pixels of 3072 that may differ by more than 1e-2, and why. Both sample the same points, so an edge
# alone is no reason.
ALLOWED = {
    # On a smooth mesh POV-Ray turns the interpolated normal to the eye, turner turns it to the side
    # of the true one: they part along silhouettes.
    "mesh": 9,
    # POV-Ray ignores what a shadow ray meets in its first 0.001: the edge of a pane, once.
    "shadows": 1,
}
EXPORTED = {"absorption", "attenuation", "bubble", "instances", "lights", "mesh", "phong_terms",
            "prism", "shadows", "whitted1980"}


def scenes():
    """Every scene that can be exported, with Phong's formula as Whitted has it."""
    need_povray()
    exported, wrong = set(), []
    for scene in sorted(SCENES.glob("*.json")):
        if scene.stem == "schema":
            continue
        figures, why_not = difference(scene, 1e-2, 0, "--shading", "phong")
        if not figures:
            print(f"{scene.stem}: not exported. {why_not}")
            continue
        exported.add(scene.stem)
        judge(scene.stem, figures, ALLOWED.get(scene.stem, 0), wrong)
    assert exported >= EXPORTED, f"no longer exported: {EXPORTED - exported}"
    assert not wrong, wrong


if __name__ == "__main__":
    what = {f.__name__: f for f in (command, runner, terms, scenes)}[sys.argv[1]]
    with tempfile.TemporaryDirectory(prefix="turner-pov-") as place:
        os.chdir(place)
        what()
        os.chdir("/")
