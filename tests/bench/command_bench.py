"""command_bench.py files | wrong | growth | stages | interrupted | refused: what `turner bench` does.

Environment: TURNER, the command; TURNER_SHADERS, its shaders. Exit status 77 without a Vulkan
device. No time is judged.
"""

import csv
import json
import os
import pathlib
import signal
import subprocess
import sys
import tempfile
import time

TURNER = os.environ["TURNER"]
SHADERS = pathlib.Path(os.environ["TURNER_SHADERS"])
KINDS = ["camera", "shadow", "mirror 1", "mirror 2", "mirror 3", "random"]
SMALL = ["--size", "64x64", "--rounds", "2", "--check", "1000"]
SCENE = """{"version": 1, "camera": {"from": [0, 1, 5], "at": [0, 0, 0]},
 "materials": {"grey": {"k_d": 0.5}}, "groups": {"pair": [
  {"type": "sphere", "center": [0, 0, 0], "radius": 1, "material": "grey"},
  {"type": "box", "min": [-3, -2, -2], "max": [3, -1, 1], "material": "grey"}]},
 "instances": [{"group": "pair"},
               {"group": "pair", "transform": [{"translate": [1, 1, -2]}, {"scale": 0.5}]}]%s,
 "lights": [{"type": "point", "position": [2, 4, 3], "intensity": 30}]}"""
PLANE = ', "primitives": [{"type": "plane", "point": [0, -3, 0], "normal": [0, 1, 0], ' \
        '"material": "grey"}]'


def bench(*arguments, status=0):
    print("$ turner bench", *arguments)
    done = subprocess.run([TURNER, "bench", *arguments], capture_output=True, text=True,
                          timeout=300)
    print(done.stdout, done.stderr, "=>", done.returncode, sep="")
    assert done.returncode == status, f"status {done.returncode}, expected {status}"
    return done


def rows(name="out/bench.csv"):
    with open(name, newline="", encoding="utf-8") as file:
        return list(csv.DictReader(file))


def has_embree():
    return not json.loads(pathlib.Path("out/bench.json").read_text())["embree"].endswith(")")


def check_row(row):
    assert float(row["rays_per_second"]) > 0, row
    assert float(row["first_quartile"]) <= float(row["rays_per_second"]) <= \
        float(row["third_quartile"]), row
    assert int(row["rounds"]) == 2 and int(row["checked"]) >= 1000 and row["wrong"] == "0", row


def files():
    """Every tracer of every kind of rays has its row and its figure; so has every builder."""
    pathlib.Path("pair.json").write_text(SCENE % "")
    pathlib.Path("plane.json").write_text(SCENE % PLANE)
    out = bench(*SMALL, "-o", "out", "sphereflake:2", "pair.json", "plane.json").stdout
    table = rows()
    own = [row for row in table if row["tracer"] == "bvh"]
    assert [row["scene"] for row in own] == sum(
        ([name] * 6 for name in ("sphereflake:2", "pair.json", "plane.json")), []), "scenes"
    assert [row["rays"] for row in own] == KINDS * 3, "kinds"
    assert all(f"\n{kind} " in out for kind in KINDS), "the table lacks some rays"
    assert own[0]["ray_count"] == "4096" and own[0]["primitives"] == "91", own[0]
    for row in table:
        embree = row["tracer"].startswith("embree")
        if int(row["ray_count"]) < 1000:
            assert row["left_out"] == "too few rays" and not row["rays_per_second"], row
        elif embree and (row["scene"] == "plane.json" or not has_embree()):
            assert row["left_out"] == "-" and not row["rays_per_second"], row
        elif row["tracer"] == "ray_query" and not row["rays_per_second"]:
            assert row["left_out"] == "-", row  # not every device has them
        else:
            check_row(row)
    assert any(int(row["ray_count"]) >= 1000 for row in own if row["rays"] == "random"), "rays"
    builds = {(row["scene"], row["tracer"]): row for row in rows("out/build.csv")}
    for scene in ("sphereflake:2", "pair.json", "plane.json"):
        row = builds[scene, "bvh"]
        assert float(row["seconds"]) > 0 and int(row["bytes"]) > 48 * int(row["primitives"]), row
    if has_embree():
        assert ("pair.json", "embree") in builds and ("plane.json", "embree") not in builds
    report = json.loads(pathlib.Path("out/bench.json").read_text())
    assert report["device"] and report["driver"] and report["threads"] >= 1, "who measured"
    assert [stream["rays"] for stream in report["scenes"][0]["streams"]] == KINDS
    assert not list(pathlib.Path("out").glob("*.part")), "something half is left"


# What is wrong with a kernel, as changes to rays.comp that a compiler would not notice.
WRONG = {
    "far": ("float(search.hit.t)", "1.001 * float(search.hit.t)"),
    "loses": ("search.found ? float", "search.found && index % 50u != 7u ? float"),
    "sees": ("search.found ? float", "index % 50u == 7u ? 1.0 : search.found ? float"),
}


def wrong():
    """A kernel that is wrong on few rays gets no figure and fails; the others keep theirs."""
    right = (SHADERS / "rays.comp").read_text(encoding="utf-8")
    pathlib.Path("same").mkdir()
    pathlib.Path("same/rays.comp").write_text(right)
    bench(*SMALL, "-o", "out", "--with", "same", "--rays", "camera", "sphereflake:3")
    assert [row["tracer"] for row in rows()][:2] == ["bvh", "bvh same"]
    check_row(rows()[1])
    for name, (old, new) in WRONG.items():
        assert right.count(old) == 1, f"rays.comp has changed: {old}"
        pathlib.Path(name).mkdir()
        pathlib.Path(name, "rays.comp").write_text(right.replace(old, new))
        kinds = ["camera", "shadow", "random"]
        if name == "far":
            kinds.remove("shadow")  # how far does not matter there
        done = bench(*SMALL, "-o", "out", "--with", name, "--rays", ",".join(kinds), "--tracers",
                     f"bvh,bvh {name}", "sphereflake:3", status=1)
        table = rows()
        assert [row["rays"] for row in table] == [kind for kind in kinds for _ in range(2)], table
        for good, bad in zip(table[::2], table[1::2], strict=True):
            check_row(good | {"checked": "1000"})
            assert bad["tracer"] == f"bvh {name}" and int(bad["wrong"]) > 1, bad
            assert not bad["rays_per_second"] and "wrong" in bad["left_out"], bad
            said = f"{bad['rays']} rays: bvh {name} meets other things"
            assert said in done.stderr, "no warning"
    pathlib.Path("broken").mkdir()
    pathlib.Path("broken/rays.comp").write_text(right.replace("void main()", "void main("))
    assert "broken/rays.comp:" in bench(*SMALL, "--with", "broken", "sphereflake:1",
                                        status=3).stderr


def growth():
    """Sizes in steps, and the fit."""
    out = bench("--size", "64x64", "--rounds", "2", "--check", "200", "--growth=100000", "-o",
                "out").stdout
    table = [row for row in rows() if row["tracer"] == "bvh"]
    assert [row["scene"] for row in table] == ["mesh:10000"] * 2 + ["mesh:31623"] * 2 + \
        ["mesh:100000"] * 2, "sizes"
    assert {row["rays"] for row in table} == {"camera", "random"}, "kinds"
    report = json.loads(pathlib.Path("out/bench.json").read_text())
    fits = {(fit["tracer"], fit["rays"]): fit for fit in report["growth"]}
    assert {("bvh", "camera"), ("bvh", "random")} <= fits.keys() and "log2 n" in out
    fit = fits["bvh", "camera"]
    line = fit["nanoseconds"] + fit["nanoseconds_per_doubling"] * 16.6
    times = [1e9 / float(row["rays_per_second"]) for row in table if row["rays"] == "camera"]
    assert min(times) / 2 < line < 2 * max(times), (line, times)


def stages():
    """Pictures from start to end, twice: with empty caches and with full ones."""
    pathlib.Path("pair.json").write_text(SCENE % PLANE)
    os.environ["TMPDIR"] = os.getcwd()
    out = bench("--stages", "--rounds", "1", "-o", "out", "pair.json").stdout
    table = {(row["caches"], row["stage"]): float(row["seconds"])
             for row in rows("out/stages.csv")}
    for caches in ("empty", "full"):
        parts = [table[caches, stage] for stage in ("parse", "build", "compile", "upload", "trace",
                                                    "read_back", "write")]
        assert all(part >= 0 for part in parts) and table[caches, "trace"] > 0, parts
        assert table[caches, "all"] > table[caches, "trace"], table
    assert "\nall " in out and "\nrest " in out
    assert bench("--stages", "no.json", status=3).stdout == ""
    assert not list(pathlib.Path(".").glob("turner-bench-*")), "a folder was left"


def interrupted():
    """Whatever ends it, nothing is written half."""
    for number in (signal.SIGINT, signal.SIGTERM):
        child = subprocess.Popen([TURNER, "bench", "-q", "--rounds", "101", "-o", "out",
                                  "sphereflake:3"], stdout=subprocess.DEVNULL)
        time.sleep(1.5)
        child.send_signal(number)
        assert child.wait(timeout=30) == 128 + number, "status"
        assert not list(pathlib.Path("out").iterdir()), "something was left"


def refused():
    """Wrong command lines and files."""
    for arguments, word in ((["--rays", "cameras"], "camera"), (["--tracers", "optix"], "embree"),
                            (["--rounds", "0"], "--rounds"), (["--growth=99"], "--growth"),
                            (["--growth", "a.json"], "--growth"), (["--stages"], "scene files"), (["--what"], "--help"),
                            (["sphereflake:9"], "sphereflake:9"),
                            (["--size", "60000x60000"], "64 million")):
        assert word in bench(*arguments, status=2).stderr, word
    assert "no.json" in bench("no.json", status=3).stderr
    pathlib.Path("file").write_text("")
    assert "folder" in bench("-o", "file", "sphereflake:0", status=5).stderr
    assert "Examples:" in bench("--help").stdout


def main():
    probe = subprocess.run([TURNER, "devices"], capture_output=True, text=True)
    if probe.returncode != 0 or "bvh         yes" not in probe.stdout:
        print("skipped:", probe.stderr.strip() or "no Vulkan device has what turner requires")
        sys.exit(77)
    with tempfile.TemporaryDirectory(prefix="turner-bench-") as folder:
        os.chdir(folder)
        {"files": files, "wrong": wrong, "growth": growth, "stages": stages,
         "interrupted": interrupted, "refused": refused}[sys.argv[1]]()
        os.chdir("/")


main()
