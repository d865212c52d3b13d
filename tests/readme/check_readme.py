#!/usr/bin/env python3
"""What README.md says works: check_readme.py ROOT TURNER WORK.

Its scene is accepted by `turner check` and rendered; every file it or CONTRIBUTING.md links to or
names in `backticks` exists."""
import json
import os
import re
import subprocess
import sys


def main():
    root, turner, work = sys.argv[1:]
    text = {}
    for name in ("README.md", "CONTRIBUTING.md"):
        with open(os.path.join(root, name), encoding="utf-8") as file:
            text[name] = file.read()

    failures = []
    for name, content in text.items():
        links = re.findall(r"\]\(([^)#:]+)[^):]*\)", content)
        links += re.findall(r"`((?:src|shaders|scenes|tests|tools|docs|cmake)/[\w./-]*)", content)
        assert links, f"{name}: no links found: is this check still right?"
        for link in links:
            if not os.path.exists(os.path.join(root, link)):
                failures.append(f"{name}: {link} does not exist")

    blocks = re.findall(r"^```json\n(.*?)^```", text["README.md"], re.M | re.S)
    if len(blocks) != 1:
        failures.append(f"README.md: {len(blocks)} JSON blocks, expected one scene")
    for block in blocks:
        json.loads(block)
        os.makedirs(work, exist_ok=True)
        scene, picture = os.path.join(work, "readme.json"), os.path.join(work, "readme.png")
        with open(scene, "w", encoding="utf-8") as file:
            file.write(block)
        if os.path.exists(picture):
            os.remove(picture)
        for command in ([turner, "check", scene],
                        [turner, "render", scene, "--device", "reference", "--size", "64x48",
                         "-o", picture]):
            if subprocess.run(command, check=False).returncode != 0:
                failures.append(f"README.md: its scene fails: {' '.join(command)}")
        if not os.path.exists(picture):
            failures.append("README.md: its scene gave no picture")

    print("\n".join(failures) if failures else "README.md: its scene and its links are right")
    return 1 if failures else 0


if __name__ == "__main__":
    sys.exit(main())
