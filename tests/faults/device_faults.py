"""Devices that are not there, cannot do it, or are asked for too much; shaders that are broken."""

import os
import pathlib
import time

from harness import BAD_INPUT, DEVICE, FULL_SCENE, USAGE, fault, require

RENDER = ("render", "scene.json", "-o", "picture.png")
NO_DRIVER = ("no Vulkan driver found; install mesa-vulkan-drivers (it brings a device in software) "
             "or your graphics card's driver, or use --device reference")
SHADERS = pathlib.Path(__file__).resolve().parents[2] / "shaders"


@fault
def no_vulkan_driver(place):
    for variable in ("VK_DRIVER_FILES", "VK_ICD_FILENAMES"):
        env = {variable: "/nonexistent", "TURNER_VALIDATION": "0"}
        place.refuses(DEVICE, NO_DRIVER, *RENDER, env=env)
        place.refuses(DEVICE, NO_DRIVER, "devices", env=env)
        place.refuses(DEVICE, NO_DRIVER, *RENDER, "--device", "0", env=env)
        place.succeeds("check", "scene.json", SHADERS / "render.comp", env=env)
        place.succeeds(*RENDER, "--device", "reference", env=env)
        (place.folder / "picture.png").unlink()


@fault(device=True)
def no_ray_query(place):
    """The extension masked: named where it is asked for, not missed where it is not."""
    place.write("scene.json", FULL_SCENE)
    place.succeeds("render", "scene.json", "-o", "before.exr", "--traversal", "bvh")
    masked = {"TURNER_MASK_EXTENSIONS": "VK_KHR_ray_query"}
    place.refuses(DEVICE, ["cannot trace with ray queries: it lacks VK_KHR_ray_query; use "
                           "--traversal bvh, or auto"],
                  *RENDER, "--traversal", "ray_query", env=masked)
    for traversal in ("auto", "bvh"):
        place.succeeds("render", "scene.json", "-o", traversal + ".exr", "--traversal", traversal,
                       env=masked)
    out = place.succeeds("devices", env=masked)
    require("ray_query   no, lacks VK_KHR_ray_query" in out and "auto        bvh" in out,
            "turner devices does not say so")
    files = place.files()
    require(files["auto.exr"] == files["before.exr"] == files["bvh.exr"], "another picture")


@fault(device=True)
def no_acceleration_structures(place):
    """What ray queries need besides is named, too."""
    place.refuses(DEVICE, "it lacks VK_KHR_acceleration_structure", *RENDER, "--traversal",
                  "ray_query", env={"TURNER_MASK_EXTENSIONS": "VK_KHR_acceleration_structure"})


@fault(device=True)
def no_such_device(place):
    for name in ("99", "-1", "nonsense"):
        place.refuses(USAGE, [f'no device "{name}"; those here are 0: '], *RENDER, "--device", name)


@fault
def picture_too_large(place):
    """Refused in advance, with what it takes and what there is."""
    for options in ([], ["--device", "reference"]):
        start = time.monotonic()
        err = place.refuses(DEVICE, ["a picture of 65536×65536 pixels takes 65536.0 MiB, but only ",
                                     " MiB of memory are free; choose a smaller size"],
                            *RENDER, "--size", "65536x65536", *options)
        free = float(err.split("but only ")[1].split()[0])
        pages = os.sysconf("SC_PHYS_PAGES") * os.sysconf("SC_PAGE_SIZE") / 2**20
        require(0 < free <= pages, "the figure of free memory cannot be true")
        require(time.monotonic() - start < 10, "that took long")


@fault(device=True)
def largest_depth(place):
    """The deepest that is allowed works, with as many rays as it may take."""
    place.write("scene.json", FULL_SCENE)
    place.refuses(BAD_INPUT, 'material "glass": it both reflects and transmits, so depth 1024 is too much; '
                  "64 is the limit",
                  *RENDER, "--depth", "1024")
    place.succeeds(*RENDER, "--depth", "64", "--size", "16x12", "--cutoff", "0.01")


def shader_fault(name, old, new, message):
    """A shader with `old` replaced; the message has the place and the line."""
    def check(place):
        text = (SHADERS / "render.comp").read_text()
        require(old in text, f"render.comp has changed: no {old}")
        line = text[:text.index(old)].count("\n") + 1
        place.write("shaders/render.comp", text.replace(old, new, 1))
        shown_line = place.files()["shaders/render.comp"].decode().splitlines()[line - 1]
        shown = shown_line.strip()
        column = shown_line.index(new) + 1 if new in shown_line else 1
        messages = [part.replace("LINE", str(line)).replace("COLUMN", str(column))
                    .replace("TEXT", shown) for part in message]
        place.refuses(BAD_INPUT, messages, *RENDER, "--shader-dir", "shaders")
        status, _, err = place.run("check", "shaders/render.comp")
        require(status == BAD_INPUT and all(part in err for part in messages),
                "turner check does not say the same")
    fault(check, name="shader_" + name, device=True)


shader_fault("with_unknown_name", "scene_block(dispatch.scene).the", "nonsense",
             ["shaders/render.comp:LINE:COLUMN: 'nonsense' : undeclared identifier", "\n    TEXT\n"])
shader_fault("with_syntax_error", "uint item = 0u;", "uint item = 0u",
             ["shaders/render.comp:", "syntax error"])
shader_fault("with_missing_include", '#include "whitted.glsl"', '#include "whited.glsl"',
             ["shaders/render.comp:LINE:1: ", '"whited.glsl" is neither in shaders, nor built into '
              "the program"])


@fault(device=True)
def shader_folder_missing(place):
    place.refuses(BAD_INPUT, "shader folder no: No such file or directory; check its name",
                  *RENDER, "--shader-dir", "no")
    place.refuses(BAD_INPUT, "shader folder scene.json: Not a directory; check its name",
                  *RENDER, "--shader-dir", "scene.json")


@fault(device=True)
def shader_folder_empty(place):
    """Nothing is replaced, which is no fault: the same picture."""
    (place.folder / "shaders").mkdir()
    place.succeeds(*RENDER)
    place.succeeds("render", "scene.json", "-o", "other.png", "--shader-dir", "shaders")
    files = place.files()
    require(files["picture.png"] == files["other.png"], "another picture")
