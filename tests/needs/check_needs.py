"""check_needs.py lists | warnings | precision | measure: `turner check --needs` and what it does.

Environment: TURNER, the command; TURNER_SCENES, the folder of scenes.
"""

import csv
import json
import math
import os
import pathlib
import re
import subprocess
import sys
import tempfile

TURNER = os.environ["TURNER"]
SCENES = sorted(path for path in pathlib.Path(os.environ["TURNER_SCENES"]).glob("*.json")
                if path.name != "schema.json")
DEEP = """{"version": 1, "camera": {"from": [0, 1, 5], "at": [0, 0, 0]}, "background": 0.5,
 "settings": {"size": [40, 30], "depth": 20}, "materials": {"grey": {"k_d": 0.5}},
 "primitives": [{"type": "sphere", "center": [0, 0, 0], "radius": 1, "material": "grey"}]}"""


def turner(*arguments, status=0):
    print("$ turner", *arguments)
    done = subprocess.run([TURNER, *map(str, arguments)], capture_output=True, text=True,
                          timeout=280)
    print(done.stdout[:1000], done.stderr, "=>", done.returncode, sep="")
    assert done.returncode == status, f"exit status {done.returncode}, not {status}"
    return done


def lists():
    """A scene's needs, in text and as JSON, say the same; kernels are smaller than everything."""
    names = ("attenuation", "fresnel", "lights", "mirrors", "underwater")
    scenes = [path for path in SCENES if path.stem in names]
    reports = json.loads(turner("check", "--needs", "--json", *scenes).stdout)
    assert [r["scene"] for r in reports] == [str(path) for path in scenes]
    text = turner("check", "--needs", *scenes[:2]).stdout
    for report in reports[:2]:
        for n in report["needs"]:
            assert f"{n['feature']}: {n['why']}\n" in text, n
    for report in reports:
        wanted = {n["feature"] for n in report["needs"]}
        left = set(report["left_out"])
        assert wanted and left and not wanted & left and len(wanted | left) == 25
        assert all(n["why"] and n["count"] >= 1 for n in report["needs"])
        kernel = report["kernel"]
        assert 0 < kernel["spirv_bytes"] < kernel["spirv_bytes_everything"]
        depth = report["depth"]
        assert (depth["useful"] == 0) == (depth["largest_weight"] == 0)
        assert (depth["largest_weight"] == 0) == (not wanted & {"reflection", "transmission"})
    mirrors = next(r for r in reports if r["scene"].endswith("mirrors.json"))
    assert mirrors["depth"]["useful"] == 66, "0.92^66 = 0.00407, the cutoff is 0.004"
    # each kind of kernel has its own size
    pathlib.Path("f64.json").write_text(DEEP.replace('"depth": 20',
                                                     '"methods": {"precision": "f64"}'))
    pathlib.Path("f32.json").write_text(DEEP)
    double, single = json.loads(turner("check", "--needs", "--json", "f64.json",
                                       "f32.json").stdout)
    assert double["precision"]["setting"] == "f64" and single["precision"]["setting"] == "f32"
    assert double["kernel"]["spirv_bytes"] > single["kernel"]["spirv_bytes"]
    assert double["precision"]["f64_can_show"] == {"bits_8": False, "bits_16": True, "float": True}
    turner("check", "--needs", "--traversal", "ray_query", "f64.json", status=2)
    turner("check", "--json", SCENES[0], status=2)
    turner("check", "--needs", "missing.json", status=3)


def warnings():
    """Scenes that come with turner ask for no more than they show, but for the one that shows it;
    render warns as check does, and --quiet keeps it quiet."""
    said = turner("check", *SCENES).stderr.splitlines()
    assert len(said) == 1 and "fresnel.json: material \"exact 1.0\" cannot be seen" in said[0], said
    pathlib.Path("deep.json").write_text(DEEP)
    picture = ("render", "deep.json", "-o", "p.png", "--device", "reference")
    for arguments in (("check", "deep.json"), picture):
        assert "warning: deep.json: depth 20, but nothing reflects" in turner(*arguments).stderr
        assert turner(*arguments, "--quiet").stderr == ""
    assert turner(*picture, "--depth", "0").stderr == ""
    f64 = ("--depth", "0", "--method", "precision=f64")
    assert "f32 is at the limit of a picture of 8 bits" in turner(*picture, *f64).stderr
    assert turner("render", "deep.json", "-o", "p.exr", "--device", "reference", *f64).stderr == ""


def skip_without_device():
    probe = subprocess.run([TURNER, "devices"], capture_output=True, text=True)
    if probe.returncode != 0 or "bvh         yes" not in probe.stdout:
        print("skipped:", probe.stderr.strip() or "no Vulkan device has what turner requires")
        sys.exit(77)


def precision():
    """A glowing ball far from the origin, drawn in single precision and by the reference: no more
    pixels differ than the estimate says, the ball's outline times the pixels it moves; and where it
    says pixels are lost, some are."""
    skip_without_device()
    size, distance, vfov = 400, 3, 60
    shifts = {"near": 0, "far": 1e4, "beyond": 1e5}
    for name, shift in shifts.items():
        scene = {"version": 1, "settings": {"size": [size, size], "depth": 0},
                 "camera": {"from": [shift + 0.12345, 0.31, distance],
                            "at": [shift + 0.12345, 0.31, 0], "vfov": vfov},
                 "materials": {"m": {"k_e": 1}}, "primitives": [
                     {"type": "sphere", "center": [shift, 0, 0], "radius": 1, "material": "m"}]}
        pathlib.Path(f"{name}.json").write_text(json.dumps(scene))
    reports = json.loads(turner("check", "--needs", "--json",
                                *(f"{name}.json" for name in shifts)).stdout)
    for name, report in zip(shifts, reports):
        turner("render", f"{name}.json", "-o", "device.png", "-q")
        turner("render", f"{name}.json", "-o", "reference.png", "-q", "--device", "reference")
        done = subprocess.run([TURNER, "compare", "device.png", "reference.png"],
                              capture_output=True, text=True, timeout=60)
        wrong = int(re.search(r"pixels over it +(\d+) of", done.stdout)[1])
        outline = 2 * math.pi / (distance * 2 * math.tan(math.radians(vfov / 2)) / size)
        moved = report["precision"]["f32_moves_edges_pixels"]
        print(f"{name}: {wrong} pixels differ, at most {outline * moved:.1f}")
        assert wrong <= outline * moved + 3, "chance may take a pixel or two"
        assert (wrong >= 10) == (moved > 0.5), "it moves by pixels, and nothing is lost"


def measure():
    """Two scenes, few and small runs: CSV and JSON agree, and the pictures are the same."""
    skip_without_device()
    scenes = [path for path in SCENES if path.name in ("lights.json", "prism.json")]
    done = turner("check", "--measure", "out", "--size", "16x12", "--spp", "1", *scenes)
    assert done.stdout.count("the same") == 2
    with open("out/needs.csv", newline="", encoding="utf-8") as file:
        rows = list(csv.DictReader(file))
    data = json.loads(pathlib.Path("out/needs.json").read_text())
    assert data["device"] and data["driver"] and data["runs"] == 5 and data["features"] == 25
    assert [r["scene"] for r in rows] == [s["scene"] for s in data["scenes"]] == [
        str(path) for path in scenes]
    for row, scene in zip(rows, data["scenes"]):
        assert row["same_bytes"] == "yes" and scene["same_bytes"] is True
        assert (row["width"], row["height"], row["samples"], row["runs"]) == ("16", "12", "1", "5")
        for suffix, kind in (("", "needed"), ("_everything", "everything")):
            runs = sorted(scene[kind]["trace_seconds_runs"])
            assert len(runs) == 5 and runs[0] > 0
            assert scene[kind]["trace_seconds"] == runs[2], "the median"
            assert float(row[f"trace_seconds{suffix}_least"]) <= float(
                row[f"trace_seconds{suffix}"]) <= float(row[f"trace_seconds{suffix}_most"])
            assert int(row[f"spirv_bytes{suffix}"]) == scene[kind]["spirv_bytes"] > 0
            assert scene[kind]["compile_seconds"] > 0
        assert 0 < scene["size_ratio"] < 1
        ratios = sorted(a / b for a, b in zip(scene["needed"]["trace_seconds_runs"],
                                              scene["everything"]["trace_seconds_runs"]))
        assert abs(scene["time_ratio"] - ratios[2]) < 1e-9, "the median"
        assert abs(float(row["time_ratio"]) - ratios[2]) < 1e-4
        assert abs(scene["time_ratio_least"] - ratios[0]) < 1e-9
        assert abs(scene["time_ratio_most"] - ratios[4]) < 1e-9
    assert scenes[0].name == "lights.json" and data["scenes"][0]["size_ratio"] < data["scenes"][1][
        "size_ratio"], "spheres and lamps need less than a prism"
    if "no pictures are drawn" not in done.stderr:
        assert pathlib.Path("out/needs.png").read_bytes()[:8] == b"\x89PNG\r\n\x1a\n"
        assert "</svg>" in pathlib.Path("out/needs.svg").read_text()
    turner("check", "--measure", "out", "--runs", "4", scenes[0], status=2)
    turner("check", "--measure", "no/such/folder", scenes[0], status=5)


def main():
    with tempfile.TemporaryDirectory(prefix="turner-needs-") as folder:
        os.chdir(folder)
        {"lists": lists, "warnings": warnings, "precision": precision, "measure": measure}[sys.argv[1]]()
        os.chdir("/")


main()
