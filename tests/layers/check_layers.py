#!/usr/bin/env python3
"""Checks the rules of the layout on a source tree: check_layers.py ROOT. One line a fault.

- An #include in src/ names "layer/file.h" (or "turner.h") and goes to the same layer or one below.
  shaders/ may be included by what feeds the kernel; the reference and all below it may not, because
  it is to be independent of the shaders.
- Vulkan's headers only where the GPU is spoken to.
- No file above 800 lines.
- No note of unfinished work and no absolute path into somebody's folders.
"""
import os
import re
import sys

# Highest first; the same list as in CONTRIBUTING.md.
LAYERS = ["app", "view", "render", "gpu", "bvh", "reference", "scene", "image", "base"]
SEES_SHADERS = {"app", "view", "render", "gpu", "bvh"}
SEES_VULKAN = {"view", "render", "gpu"}
SOURCE_FOLDERS = ["src", "shaders", "tests", "tools"]
TEXT_FOLDERS = SOURCE_FOLDERS + ["cmake", "docs", "scenes", ".ci", "."]
SKIPPED = {"build", ".git", "corpus", "__pycache__"}
MAX_LINES = 800

INCLUDE = re.compile(r'^\s*#\s*include\s*([<"])([^>"]+)[>"]')
VULKAN = re.compile(r"^(vulkan|vk_video|GLFW)/")
UNFINISHED = re.compile(r"\b(?:%s)\b" % "|".join(["TO" "DO", "FIX" "ME", "X" "XX", "HA" "CK"]))
MACHINE_PATH = re.compile(r"(?<![\w.}/-])/(?:home|root|work|Users|mnt|media|srv)/")


def files(root, folders):
    """Paths relative to root of the text files under the folders ("." means root itself only)."""
    for folder in folders:
        for path, subfolders, names in os.walk(os.path.join(root, folder)):
            subfolders[:] = sorted(set(subfolders) - SKIPPED) if folder != "." else []
            for name in sorted(set(names) - SKIPPED):
                yield os.path.normpath(os.path.relpath(os.path.join(path, name), root))


def lines_of(path):
    try:
        with open(path, encoding="utf-8") as file:
            return file.read().splitlines()
    except UnicodeDecodeError:
        return None  # a picture or a mesh


def include_fault(layer, path, bracket, name):
    """What is wrong with `#include name` in a file of src/LAYER, or None. `layer` is None for
    turner.h, which includes the C library only."""
    if bracket == "<":
        if VULKAN.match(name) and layer not in SEES_VULKAN:
            return f"<{name}>: Vulkan is known only to {', '.join(sorted(SEES_VULKAN))}"
        return None
    if name == "turner.h":
        return None
    if name.startswith("shaders/") or name.startswith("../shaders/") or name == "shared.h":
        if layer not in SEES_SHADERS:
            return f'"{name}": {layer} knows nothing of the shaders'
        return None
    target = name.split("/")[0]
    if "/" not in name or target not in LAYERS:
        return f'"{name}": write it as "layer/file.h"'
    if layer is None or LAYERS.index(target) < LAYERS.index(layer):
        return f'"{name}": {layer} is below {target} and may not include it'
    return None


def faults(root):
    found = []
    for path in files(root, ["src"]):
        parts = path.split(os.sep)
        layer = parts[1] if len(parts) > 2 else None
        if layer is not None and layer not in LAYERS:
            found.append(f"{path}: src/{layer} is not in the list of layers")
            continue
        for number, line in enumerate(lines_of(os.path.join(root, path)) or [], 1):
            match = INCLUDE.match(line)
            fault = include_fault(layer, path, *match.groups()) if match else None
            if fault:
                found.append(f"{path}:{number}: {fault}")
    for path in files(root, SOURCE_FOLDERS):
        count = len(lines_of(os.path.join(root, path)) or [])
        if count > MAX_LINES:
            found.append(f"{path}: {count} lines, {MAX_LINES} are allowed: split it by concept")
    for path in files(root, TEXT_FOLDERS):
        for number, line in enumerate(lines_of(os.path.join(root, path)) or [], 1):
            for rule, what in ((UNFINISHED, "note of unfinished work"),
                               (MACHINE_PATH, "path of one machine")):
                if rule.search(line):
                    found.append(f"{path}:{number}: {what}: {rule.search(line).group()}")
    return found


def main():
    if len(sys.argv) != 2 or not os.path.isdir(os.path.join(sys.argv[1], "src")):
        print(__doc__, file=sys.stderr)
        return 2
    found = faults(sys.argv[1])
    print("\n".join(found) if found else "layers: nothing found")
    return 1 if found else 0


if __name__ == "__main__":
    sys.exit(main())
