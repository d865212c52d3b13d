"""What the tests of shaders have in common: a folder, a scene, the command, pictures.

Environment: TURNER, the command; TURNER_SOURCE, where turner's own shaders and tools/ are.
"""

import json
import os
import pathlib
import subprocess
import sys
import tempfile

TURNER = os.environ["TURNER"]
SOURCE = pathlib.Path(os.environ["TURNER_SOURCE"])
sys.path.insert(0, str(SOURCE / "tools"))
import exr  # noqa: E402

# A floor that fills the picture, looked at from straight above; one light over the origin.
SCENE = {
    "version": 1,
    "settings": {"size": [16, 12], "shading": "phong"},
    "camera": {"from": [0, 4, 0], "at": [0, 0, 0], "up": [0, 0, -1], "vfov": 30},
    "materials": {"floor": {"k_d": 0.5}},
    "primitives": [{"type": "plane", "point": [0, 0, 0], "normal": [0, 1, 0],
                    "material": "floor"}],
    "lights": [{"type": "point", "position": [0, 3, 0], "intensity": 9, "falloff": "none"}],
}


def turner(*arguments, status=0, **more):
    """Runs it; its messages are in `stderr`."""
    done = subprocess.run([TURNER, *map(str, arguments)], capture_output=True, text=True,
                          timeout=120, **more)
    print("$ turner", *arguments, "=>", done.returncode)
    print(done.stdout[:2000] + done.stderr[:2000], end="")
    assert done.returncode == status, f"status {done.returncode}, not {status}"
    return done


def write(path, text):
    path = pathlib.Path(path)
    path.parent.mkdir(parents=True, exist_ok=True)
    path.write_text(text if isinstance(text, str) else json.dumps(text))


def draw(scene, *options, output="picture.exr"):
    """The picture's colours, (x, y) -> (r, g, b)."""
    turner("render", scene, "-o", output, "-q", *options)
    picture = exr.read(output)
    red, green, blue = (picture.channels[c] for c in "RGB")
    return {(i % picture.width, i // picture.width): (red[i], green[i], blue[i])
            for i in range(picture.width * picture.height)}


def close(a, b, relative=3e-6):
    """Floats made of a few operations each."""
    return all(abs(x - y) <= relative * max(abs(x), abs(y), 1e-6) for x, y in zip(a, b))


def run(tests, device=True):
    """Runs the tests named on the command line, each in a folder of its own; 77 without a device."""
    probe = subprocess.run([TURNER, "devices"], capture_output=True, text=True) if device else None
    if probe and (probe.returncode != 0 or "bvh         yes" not in probe.stdout):
        print("skipped:", probe.stderr.strip() or "no Vulkan device has what turner requires")
        sys.exit(77)
    for name in sys.argv[1:]:
        with tempfile.TemporaryDirectory(prefix="turner-shaders-") as folder:
            os.chdir(folder)
            tests[name]()
            os.chdir("/")
