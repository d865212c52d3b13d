#!/usr/bin/env python3
"""check_report.py TURNER WORK: the files of `turner stability -o`, and that measured figures are
those that others have published (exit 77: no device)."""
import csv
import json
import os
import shutil
import subprocess
import sys

# (row, method, value): published figure and the factor within which ours must lie. The share of
# wrong rays depends on how far beyond the silhouette one aims, rounding on the device's
# instructions: those have a wide factor. Formulas have none.
PUBLISHED = {
    ("sphere-distance-wrong", "textbook", "1000"): (0.045, 3),
    ("sphere-distance-wrong", "textbook", "4100"): (0.32, 3),
    ("sphere-distance-wrong", "textbook", "8000"): (0.41, 3),
    ("sphere-distance-t", "textbook", "100"): (7.5e-4, 3),
    ("sphere-distance-t", "textbook", "1000"): (0.059, 3),
    ("sphere-distance-t", "textbook", "4100"): (0.72, 3),
    ("sphere-distance-t", "robust (default)", "1000"): (4e-5, 3),
    ("sphere-distance-t", "robust (default)", "8000"): (3e-4, 3),
    ("sphere-distance-t", "robust (default)", "100000"): (4.7e-3, 3),
    ("sphere-ground", "robust (default)", "1000"): (1.2e-5, 3),
    ("sphere-ground", "robust (default)", "100000"): (1.6e-3, 3),
    ("sphere-ground", "robust (default)", "1e+06"): (1.3e-2, 3),
    ("sphere-ground", "robust (default)", "1e+07"): (0.17, 3),
    ("schlick-outside", "schlick", "1.05"): (0.317, 1.01),
    ("schlick-outside", "schlick", "1.333"): (0.059, 1.01),
    ("schlick-outside", "schlick", "1.5"): (0.0357, 1.01),
    ("schlick-outside", "schlick", "1.6"): (0.0319, 1.01),
    ("schlick-outside", "schlick", "2"): (0.044, 1.02),
    ("schlick-outside", "schlick", "2.417"): (0.075, 1.01),
    ("schlick-outside", "schlick", "3"): (0.125, 1.01),
    ("fresnel-equal", "schlick", "60"): (0.03125, 1.001),
    ("fresnel-equal", "schlick", "80"): (0.385, 1.002),
    ("phong-albedo", "phong", "1"): (3.14159, 1.001),
    ("phong-albedo", "phong", "5"): (1.04720, 1.001),
    ("phong-albedo", "phong", "10"): (0.571199, 1.001),
    ("phong-albedo", "phong", "100"): (0.0622100, 1.001),
    ("mirrors-lost", "depth=25", "0.9"): (0.9 ** 26, 1.001),
    ("mirrors-lost", "depth=53", "0.99"): (0.99 ** 54, 1.001),
}
ROWS = ["sphere-distance", "sphere-ground", "schlick-outside", "fresnel-equal", "phong-albedo",
        "mirrors-lost"]


def main():
    turner, work = sys.argv[1:]
    shutil.rmtree(work, ignore_errors=True)
    os.makedirs(os.path.dirname(work), exist_ok=True)
    run = subprocess.run([turner, "stability", "--quiet", "--no-povray", "-o", work, *ROWS],
                         capture_output=True, text=True, check=False)
    sys.stderr.write(run.stderr)
    if "no Vulkan driver found" in run.stderr:
        print("skipped: no device")
        return 77
    assert run.returncode == 0, f"status {run.returncode}"

    with open(os.path.join(work, "stability.csv"), encoding="utf-8", newline="") as file:
        table = {(row["sweep"], row["method"], row["value"]): row for row in csv.DictReader(file)}
    failures = []
    for key, (figure, factor) in PUBLISHED.items():
        if key not in table:
            failures.append(f"{key}: not in the table")
            continue
        error = float(table[key]["error"] or "nan")
        if not figure / factor <= error <= figure * factor:
            failures.append(f"{key}: {error}, published {figure}, allowed factor {factor}")

    with open(os.path.join(work, "stability.json"), encoding="utf-8") as file:
        report = json.load(file)
    with open(os.path.join(work, "index.html"), encoding="utf-8") as file:
        page = file.read()
    pictures = [sweep["name"] + ".png" for sweep in report["sweeps"]]
    drawn = [name for name in pictures if os.path.exists(os.path.join(work, name))]
    if "no pictures are drawn" not in run.stderr and drawn != pictures:
        failures.append(f"of the pictures {pictures} only {drawn} were drawn")
    for sweep in report["sweeps"]:
        for text in (sweep["name"], sweep["question"], *(m["name"] for m in sweep["methods"])):
            if text not in page:
                failures.append(f"index.html does not have {text!r}")
    for name in drawn:
        if f'src="{name}"' not in page:
            failures.append(f"index.html does not show {name}")
    print("\n".join(failures) if failures else f"{len(PUBLISHED)} published figures reproduced")
    return 1 if failures else 0


if __name__ == "__main__":
    sys.exit(main())
