"""whole_bench.py: tools/bench on a tiny scene, with and without the programs it measures against, and
the tables it writes. Nothing is judged by time.

Environment: TURNER, the command; TOOLS, the folder tools/. Exit status 77 without a Vulkan device.
"""

import csv
import os
import pathlib
import shutil
import subprocess
import sys
import tempfile

TURNER, TOOLS = os.environ["TURNER"], os.environ["TOOLS"]
DOCUMENT = """# Times
<!-- table whole -->
old
<!-- end -->
between
<!-- table aa -->
stays
<!-- end -->
"""


def tool(*arguments, status=0, path=None):
    command = [sys.executable, "-B", os.path.join(TOOLS, "bench"), "--turner", TURNER, *arguments]
    print("$", *command[2:])
    done = subprocess.run(command, capture_output=True, text=True, timeout=250,
                          env=dict(os.environ, PATH=path) if path else None)
    print(done.stdout, done.stderr, "=>", done.returncode, sep="")
    assert done.returncode == status, f"status {done.returncode}, expected {status}"
    return done


def rows():
    with open("out/whole.csv", newline="", encoding="utf-8") as file:
        return {row["program"]: row for row in csv.DictReader(file)}


def main():
    subprocess.run([sys.executable, "-B", os.path.join(TOOLS, "make_sphereflake.py"), "--depth",
                    "1", "-o", "ten.nff"], check=True)
    small = ["-o", "out", "--size", "40", "--rounds", "2", "--scene", "ten.nff", "whole"]

    pathlib.Path("empty").mkdir()
    tool(*small, path=os.path.abspath("empty"))
    alone = rows()
    assert float(alone["turner"]["seconds"]) > 0 and alone["turner"]["rounds"] == "2", alone
    for other in ("POV-Ray", "Tachyon"):
        assert alone[other]["left_out"] == "not installed" and not alone[other]["seconds"], alone

    pathlib.Path("times.md").write_text(DOCUMENT)
    tool(*small, "--keep", "--document", "times.md")
    text = pathlib.Path("times.md").read_text()
    assert "old" not in text and "\n| ten | " in text and "not installed" in text, text
    assert "between" in text and "stays" in text, text
    tool(*small, "--keep", "--document", "times.md")
    assert pathlib.Path("times.md").read_text() == text, "the second time something else"

    # a program that draws something else is seen, whatever its time
    fake = pathlib.Path("fake")
    fake.mkdir()
    (fake / "povray").write_text("#!/bin/sh\nfor a; do case $a in +O*) out=${a#+O};; esac; done\n"
                                 f"exec '{TURNER}' render '{os.path.abspath('black.json')}' -q "
                                 "--size 40x40 -o \"$out\"\n")
    (fake / "povray").chmod(0o755)
    pathlib.Path("black.json").write_text('{"version": 1, "camera": {"from": [0, 0, 5], '
                                          '"at": [0, 0, 0]}}')
    tool(*small, path=os.path.abspath("fake") + ":/usr/bin:/bin")
    assert "another picture" in rows()["POV-Ray"]["left_out"], rows()["POV-Ray"]

    if shutil.which("povray"):
        tool(*small)
        row = rows()["POV-Ray"]
        assert float(row["seconds"]) > 0 and float(row["turner_by_it"]) > 0, row
    # every primitive with its material, once
    subprocess.run([TURNER, "export", "ten.nff", "--pov", "-o", "ten.pov", "-q"], check=True)
    subprocess.run([sys.executable, "-B", os.path.join(TOOLS, "pov_to_pbrt.py"), "ten.nff",
                    "ten.pov", "ten.pbrt", "--size", "40"], check=True)
    text = pathlib.Path("ten.pbrt").read_text()
    assert text.count('Shape "sphere"') == 10 and text.count('Shape "trianglemesh"') == 1, text
    assert text.count('"rgb Kd" [0.5 0.45 0.35]') == 10 and text.count("LightSource") == 3, text
    assert '"float radius" [0.16666' in text and '"integer maxdepth" [5]' in text, text

    tool("-o", "out", "what", status=2)
    tool("-o", "out", "--turner", "no/such/turner", status=2)
    pathlib.Path("broken.nff").write_text("v\nfrom 1")
    assert "broken.nff" in tool("-o", "out", "--scene", "broken.nff", "whole", status=1).stderr


if __name__ == "__main__":
    probe = subprocess.run([TURNER, "devices"], capture_output=True, text=True, check=False)
    if probe.returncode != 0 or "bvh         yes" not in probe.stdout:
        print("skipped:", probe.stderr.strip() or "no Vulkan device has what turner requires")
        sys.exit(77)
    with tempfile.TemporaryDirectory(prefix="turner-whole-") as work:
        os.chdir(work)
        main()
        os.chdir("/")
