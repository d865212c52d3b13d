#!/usr/bin/env python3
"""However the work of a picture is shared out, all of it is drawn once: work.py TURNER ROOT.

The threads of a CPU device take groups of samples one by one (shaders/work.glsl) and add up what
they count at the end, or before it no longer fits (shaders/render.comp). The picture's size is no multiple of
anything; tiles are large and small; there are samples in lists, too; counts are added up at the end,
and after each packet, as shaders do where that is made the limit."""
import json
import pathlib
import shutil
import subprocess
import sys
import tempfile

TURNER, ROOT = sys.argv[1], pathlib.Path(sys.argv[2])
SIZE = "83x61"
OFTEN = (">> 24) != 0u", ">> 0) != 0u")
failures = []


def turner(*arguments):
    run = subprocess.run([TURNER, *map(str, arguments)], capture_output=True, text=True)
    if run.returncode != 0:
        failures.append(f"turner {' '.join(map(str, arguments))}: status {run.returncode}, "
                        f"{run.stdout.strip()} {run.stderr.strip()}")
    return run


def main():
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        shaders = folder / "shaders"
        shutil.copytree(ROOT / "shaders", shaders)
        text = (shaders / "render.comp").read_text()
        if OFTEN[0] not in text:
            print("render.comp has changed: no limit of counts")
            return 1
        (shaders / "render.comp").write_text(text.replace(*OFTEN))
        for traversal in ("bvh_packet", "bvh_lane", "ray_query"):
            for aa in ("1", "adaptive:0.1,9"):
                seen = []
                ways = [[], ["--shader-dir", shaders]]
                if aa == "1":  # adaptive samples at the edges of tiles are taken twice
                    ways.append(["--tile", 16])
                for i, options in enumerate(ways):
                    picture, stats = folder / f"{i}.exr", folder / "stats.json"
                    run = turner("render", ROOT / "scenes" / "whitted1980.json", "-q", "--size",
                                 SIZE, "--method", f"aa={aa}", "--traversal", traversal, "-o",
                                 picture, "--stats", stats, *options)
                    if run.returncode != 0:
                        break
                    found = json.loads(stats.read_text())
                    seen.append((found["rays"], found["largest_depth"], found["samples"]))
                    turner("compare", folder / "0.exr", picture, "-t", 0)
                if any(one != seen[0] for one in seen):
                    failures.append(f"{traversal}, aa={aa}: counts differ: {seen}")
    print("\n".join(failures))
    return 1 if failures else 0


if __name__ == "__main__":
    sys.exit(main())
