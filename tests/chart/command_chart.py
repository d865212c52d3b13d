"""turner chart: command_chart.py whole | resume | cache | flip | samples | faults.

Environment: TURNER, the command. Exit status 77 without a Vulkan device.
"""

import csv
import json
import math
import os
import pathlib
import select
import signal
import subprocess
import sys
import tempfile
import time

TURNER = os.environ["TURNER"]
SCENE = """{"version": 1, "camera": {"from": [0, 1, 5], "at": [0, 0, 0]},
 "background": 0.5, "settings": {"size": [64, 48], "depth": 3},
 "materials": {"mirror": {"k_r": 0.8}, "grey": {"k_d": 0.5}},
 "primitives": [
  {"type": "sphere", "center": [0, 0, 0], "radius": 1, "material": "mirror"},
  {"type": "box", "min": [-3, -2, -2], "max": [3, -1, 1], "material": "grey"}],
 "lights": [{"type": "point", "position": [2, 4, 3], "intensity": 30}]}"""
GRID = '{"axes": {"aa": [1, 4], "depth": [0, 3]}}'
COMMON = ["chart", "scene.json", "--size", "32x24", "-o", "out", "--cache", "cache",
          "--reference-spp", "64"]
LABELS = ["aa=1 depth=0", "aa=1", "aa=4 depth=0", "aa=4"]


def turner(*arguments, status=0, plots=False):
    """Without pictures unless they are looked at: Python takes longer for them than all else."""
    print("$ turner", *arguments)
    env = os.environ if plots else dict(os.environ, PYTHONPATH=os.path.abspath("hidden"))
    done = subprocess.run([TURNER, *arguments], capture_output=True, text=True, timeout=300,
                          env=env)
    print(done.stdout[-1500:], done.stderr, "=>", done.returncode, sep="")
    assert done.returncode == status, f"exit status {done.returncode} instead of {status}"
    return done


def chart():
    return json.loads(pathlib.Path("out/chart.json").read_text())


def error(point, metric="rmse"):
    return point["error"][metric]


def has_matplotlib():
    return any(subprocess.run([python, "-c", "import matplotlib, numpy"],
                              capture_output=True).returncode == 0
               for python in ("python3", "/usr/bin/python3"))


def whole():
    """All outputs are there and agree; errors fall with samples and depth."""
    done = turner(*COMMON, "--grid", "grid.json", "--metric", "rmse,largest", plots=True)
    data = chart()
    assert [p["label"] for p in data["points"]] == LABELS
    by_label = {p["label"]: p for p in data["points"]}
    assert data["size"] == [32, 24] and data["threads"] >= 1 and data["driver"]
    for p in data["points"]:
        s = p["seconds"]
        assert len(s["trace"]) == 5 and s["median"] == sorted(s["trace"])[2], "median of 5 runs"
        assert s["first_quartile"] <= s["median"] <= s["third_quartile"]
        assert s["compile"] > 0 and s["upload"] > 0 and s["first_draw"] > 0
        assert p["rays"] >= 32 * 24 * int(p["methods"]["aa"])
        assert pathlib.Path("out", p["picture"]).stat().st_size > 1000
    # a mirror that reflects nothing is wrong however many samples it gets
    assert error(by_label["aa=1 depth=0"]) > 3 * error(by_label["aa=1"]) > 0
    assert error(by_label["aa=4"]) < error(by_label["aa=1"])
    own = data["reference"]["error"]
    assert 0 < own["rmse"] < error(by_label["aa=4"]) / 2, "the reference is no better than a point"
    assert own["largest"] > own["rmse"] > own["relative_mse"] > 0 and own["flip"] is None

    # the error is that of turner compare against a reference of many samples
    point = by_label["aa=1"]
    turner("render", "scene.json", "--size", "32x24", "--spp", "400", "--device", "reference",
           "-o", "truth.exr", "-q", "--cutoff", "0", "--depth", "6")
    out = subprocess.run([TURNER, "compare", "out/" + point["picture"], "truth.exr", "--json", "-"],
                         capture_output=True, text=True).stdout
    other = json.loads(out)
    assert math.isclose(other["rmse"], error(point), rel_tol=0.05), "another RMSE"

    with open("out/chart.csv", newline="", encoding="utf-8") as file:
        rows = list(csv.DictReader(file))
    assert [row["label"] for row in rows] == LABELS
    for row, p in zip(rows, data["points"]):
        assert math.isclose(float(row["rmse"]), error(p), rel_tol=1e-6)
        assert math.isclose(float(row["seconds_median"]), p["seconds"]["median"], rel_tol=1e-6)
        assert row["aa"] == p["methods"]["aa"] and row["left_out"] == "" and row["flip"] == ""
        assert (row["on_front_rmse"] == "1") == ("rmse" in p["front"])
    page = pathlib.Path("out/chart.md").read_text()
    for text in (data["device"], data["driver"], f"{data['threads']} threads", "turner 0.",
                 "| within seconds | least RMSE |", "| largest error at most | seconds |",
                 "compiling the shaders", "chart-rmse.png", "| aa=4 depth=0 |"):
        assert text in page, f"chart.md lacks: {text}"
    assert "within seconds" in done.stdout and data["device"] in done.stdout
    if has_matplotlib():
        for name in ("chart-rmse", "chart-largest"):
            assert pathlib.Path(f"out/{name}.png").read_bytes()[:4] == b"\x89PNG"
            svg = pathlib.Path(f"out/{name}.svg").read_text()
            assert "aa=4" in svg and data["device"] in svg and svg.rstrip().endswith("</svg>")
    assert not list(pathlib.Path("out").rglob("*.part"))


def runs_kept():
    return {path.name: len(json.loads(path.read_text())["seconds_trace"])
            for path in pathlib.Path("out/points").glob("*.json")}


def resume():
    """Killed in the middle it keeps what was measured, and goes on from there."""
    command = [*COMMON, "--grid", "grid.json", "--runs", "31", "-q"]
    terminal, its_end = os.openpty()
    process = subprocess.Popen([TURNER, *command[:-1]], stdout=subprocess.DEVNULL, stderr=its_end,
                               env=dict(os.environ, TERM="xterm"))
    os.close(its_end)
    end, shown = time.monotonic() + 120, b""
    while sum(runs_kept().values()) < 40 or b"to go" not in shown:
        assert time.monotonic() < end and process.poll() is None, "nothing was kept or shown"
        if select.select([terminal], [], [], 0.002)[0]:
            shown += os.read(terminal, 65536)
    process.send_signal(signal.SIGKILL)
    process.wait()
    os.close(terminal)
    assert b" s to go  aa=" in shown, "the bar does not say what runs now: " + repr(shown[-500:])
    assert all(len(line) < 80 + 4 for line in shown.split(b"\r")), "longer than a line"
    kept = {path.name: json.loads(path.read_text())
            for path in pathlib.Path("out/points").glob("*.json")}
    count = sum(len(p["seconds_trace"]) for p in kept.values())
    print(f"{count} runs of {4 * 31} kept")
    assert 40 <= count < 4 * 31 and not pathlib.Path("out/chart.json").exists()
    turner(*command)
    for name, before in kept.items():
        after = json.loads(pathlib.Path("out/points", name).read_text())
        runs = before["seconds_trace"]
        assert after["seconds_trace"][:len(runs)] == runs, "what was kept is not used"
        assert len(after["seconds_trace"]) == 31

    # a third time all is there; a point that is broken is measured again, and only that
    before = {p: p.read_bytes() for p in pathlib.Path("out/points").iterdir()}
    turner(*command)
    assert before == {p: p.read_bytes() for p in pathlib.Path("out/points").iterdir()}
    picture = sorted(p for p in before if p.suffix == ".exr")[0]
    picture.write_bytes(picture.read_bytes()[:-40])
    done = turner(*command[:-1])  # not quiet
    assert "broken" in done.stderr and picture.stem in done.stderr
    changed = {p.stem for p in before if p.read_bytes() != before[p]}
    assert changed == {picture.stem}, f"measured again: {changed}"

    # another scene is another measurement
    pathlib.Path("scene.json").write_text(SCENE.replace("0.8", "0.7"))
    turner(*command)
    assert len(runs_kept()) == 8, "a changed scene was taken for the old one"


def cache():
    """References are traced once; a broken one is not trusted."""
    command = [*COMMON, "--grid", "grid.json"]
    turner(*command)
    first, errors = chart(), [error(p) for p in chart()["points"]]
    entries = {p: (p.read_bytes(), p.stat().st_mtime_ns) for p in pathlib.Path("cache").iterdir()}
    assert len([p for p in entries if p.suffix == ".exr"]) in (2, 6), "two halves"
    turner(*command)
    assert entries == {p: (p.read_bytes(), p.stat().st_mtime_ns)
                       for p in pathlib.Path("cache").iterdir()}, "traced again"
    assert first["reference"] == chart()["reference"]

    # another picture of the right size and a cut one; a description of another and nonsense
    one, two = sorted(p for p in entries if p.suffix == ".exr")[:2]
    about_one, about_two = one.with_suffix(".json"), two.with_suffix(".json")
    for changes in ({one: entries[two][0], two: entries[two][0][:-100]},
                    {about_one: entries[about_two][0], about_two: b"{"}):
        for path, content in changes.items():
            path.write_bytes(content)
        done = turner(*command)
        assert done.stderr.count("is broken and is traced again") == 2
        assert {p: p.read_bytes() for p in pathlib.Path("cache").iterdir()} == {
            p: content for p, (content, _) in entries.items()}, "the entries are not as they were"
        assert [error(p) for p in chart()["points"]] == errors

    # more samples are another picture; a better one
    turner(*command, "--reference-spp", "256")
    assert chart()["reference"]["error"]["rmse"] < first["reference"]["error"]["rmse"]
    assert len(list(pathlib.Path("cache").iterdir())) > len(entries)


def flip():
    """Without flip-evaluator the other metrics are charted, and the reason is said."""
    done = turner(*COMMON, "--grid", "grid.json", "--metric", "flip")
    assert "turner: warning: no FLIP is charted: --flip needs python3" in done.stderr
    data = chart()
    assert "flip-evaluator" in data["flip_missing"]
    assert [c["metric"] for c in data["charts"]] == ["rmse"], "nothing in its place"
    assert all(p["error"]["flip"] is None and p["error"]["rmse"] > 0 for p in data["points"])
    assert "No FLIP: " in pathlib.Path("out/chart.md").read_text()
    # and with it, mean errors are between 0 and 1; a stand-in will do
    pathlib.Path("hidden/flip_evaluator.py").write_text(
        "def evaluate(reference, picture, kind, inputsRGB, applyMagma):\n"
        "    return None, float(abs(reference - picture).mean()), None\n")
    if subprocess.run(["python3", "-c", "import numpy"], capture_output=True).returncode == 0:
        turner(*COMMON, "--grid", "grid.json", "--metric", "flip")
        data = chart()
        assert [c["metric"] for c in data["charts"]] == ["flip"]
        assert all(0 < p["error"]["flip"] < 1 for p in data["points"])
        assert 0 < data["reference"]["error"]["flip"] < 0.1


def samples():
    """Against the same samples anti-aliasing is no error; then neither is depth, only rounding."""
    adaptive = "aa=adaptive:0.05,16"
    pathlib.Path("grid.json").write_text(GRID[:-1] + f', "also": ["{adaptive}"]}}')
    turner(*COMMON, "--grid", "grid.json")
    by_label = {p["label"]: p for p in chart()["points"]}
    assert error(by_label[adaptive]) < error(by_label["aa=4"])
    assert by_label[adaptive]["rays"] < 16 / 4 * by_label["aa=4"]["rays"]
    turner(*COMMON, "--grid", "grid.json", "--against", "samples")
    *points, last = chart()["points"]
    assert last["label"] == adaptive and "no adaptive samples" in last["left_out"]
    assert f"Left out: {adaptive}: " in pathlib.Path("out/chart.md").read_text()
    against_samples = {p["label"]: error(p) for p in points}
    turner(*COMMON, "--grid", "grid.json", "--against", "arithmetic")
    arithmetic = {p["label"]: error(p) for p in chart()["points"][:-1]}
    for label in LABELS:
        # one hit in float that is a miss in truth, at an edge, would be some 0.01
        limit = 0.003
        assert 0 < arithmetic[label] < limit, f"{label}: {arithmetic[label]}"
        if "depth=0" in label:
            assert against_samples[label] > 0.05
        else:
            assert against_samples[label] < limit
    assert all(value is None for value in chart()["reference"]["error"].values())


def faults():
    """What cannot be is said in one sentence, and nothing is begun."""
    pathlib.Path("bad.json").write_text('{"axes": {"aa": [1],\n  "dept": [2]}}')
    for arguments, status, text in (
            (["--grid", "bad.json"], 3, "bad.json:2:3: no method is called \"dept\""),
            (["--grid", "none.json"], 3, "none.json: cannot be opened"),
            (["--runs", "4"], 2, "--runs takes a whole number from 5"),
            (["--metric", "rmsee"], 2, "--metric takes one of"),
            (["--against", "truth"], 2, "--against takes one of"),
            (["--device", "reference"], 2, "the reference is what devices are compared with"),
            (["-m", "sphere=round"], 2, "takes textbook | robust | f64"),
            (["-o", "scene.json/out"], 5, "cannot make the folder")):
        done = turner(*COMMON, *arguments, status=status)
        assert done.stderr.startswith("turner: error: ") and text in done.stderr
        assert not done.stdout and sorted(os.listdir()) == [
            "bad.json", "grid.json", "hidden", "scene.json"]
    out = turner("chart", "scene.json", "--print-grid").stdout
    pathlib.Path("grid2.json").write_text(out)
    points = turner("chart", "scene.json", "--list").stdout.splitlines()
    assert turner("chart", "scene.json", "--grid", "grid2.json", "--list"
                  ).stdout.splitlines() == points
    assert 15 <= len(points) <= 40 and len(set(points)) == len(points)
    assert not any("fresnel" in p for p in points), "no glass, no Fresnel"
    assert any("depth" in p for p in points) and any("cutoff" in p for p in points)
    pathlib.Path("scene.json").write_text(SCENE.replace('"k_r": 0.8', '"k_d": 0.8'))
    points = turner("chart", "scene.json", "--list").stdout
    assert "depth" not in points and "cutoff" not in points, "no secondary rays"
    assert not os.path.exists("out")


def main():
    tests = {"whole": whole, "resume": resume, "cache": cache, "flip": flip, "samples": samples,
             "faults": faults}
    what = sys.argv[1]
    if what != "faults":
        probe = subprocess.run([TURNER, "devices"], capture_output=True, text=True)
        if probe.returncode != 0 or "bvh         yes" not in probe.stdout:
            print("skipped:", probe.stderr.strip() or "no Vulkan device has what turner requires")
            sys.exit(77)
    with tempfile.TemporaryDirectory(prefix="turner-chart-") as folder:
        os.chdir(folder)
        pathlib.Path("scene.json").write_text(SCENE)
        pathlib.Path("grid.json").write_text(GRID)
        for package in ("matplotlib", "flip_evaluator"):  # in PYTHONPATH: as if not installed
            pathlib.Path("hidden").mkdir(exist_ok=True)
            pathlib.Path("hidden", package + ".py").write_text("raise ImportError\n")
        tests[what]()
        os.chdir("/")


main()
