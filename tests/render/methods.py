#!/usr/bin/env python3
"""Methods on a device: methods.py TURNER SOURCE_DIR.

Double precision agrees with the reference to what a float picture holds, on every scene; each naive
method changes the picture where it should, and the default of each is what it says."""
import pathlib
import subprocess
import sys
import tempfile

TURNER, SOURCE = sys.argv[1], pathlib.Path(sys.argv[2])
SIZE = "48x36"
failures = []


def turner(*arguments, status=0):
    run = subprocess.run([TURNER, *map(str, arguments)], capture_output=True, text=True)
    if run.returncode != status:
        failures.append(f"turner {' '.join(map(str, arguments))}: status {run.returncode}, "
                        f"{run.stdout.strip()} {run.stderr.strip()}")
    return run


def render(scene, picture, *options):
    turner("render", scene, "-o", picture, "-q", "--size", SIZE, "--spp", 1, *options)


def main():
    with tempfile.TemporaryDirectory() as folder:
        truth, picture, other = (pathlib.Path(folder) / name for name in
                                 ("truth.exr", "picture.exr", "other.exr"))
        # colours and weights stay floats, and textures are looked up in floats; one kernel for all
        # scenes, as the driver needs seconds for each in double
        for scene in sorted((SOURCE / "scenes").glob("*.json")):
            if scene.name == "schema.json":
                continue
            render(scene, truth, "--device", "reference")
            render(scene, picture, "-m", "precision=f64", "--unspecialised")
            turner("compare", picture, truth, "-t", 2e-5, "-r", 1e-5)

        scenes = SOURCE / "scenes"
        for scene, method in [("sphereflake.json", "sphere=textbook"), ("mesh.json", "offset=none"),
                              ("mesh.json", "offset=tmin:0.01"), ("mesh.json", "offset=ulp"),
                              ("mesh.json", "triangle=moller_trumbore"),
                              ("fresnel.json", "fresnel_cosine=naive"),
                              ("fresnel.json", "fresnel=schlick"), ("fresnel.json", "fresnel=none"),
                              ("sphereflake.json", "sphere=f64")]:
            render(scenes / scene, picture)
            render(scenes / scene, other, "-m", method)
            turner("compare", other, picture, "-t", 0, status=1)
        render(scenes / "fresnel.json", picture, "-m", "fresnel=schlick")
        render(scenes / "fresnel.json", other, "-m", "fresnel=schlick", "-m", "schlick_side=incident")
        turner("compare", other, picture, "-t", 0, status=1)
        # the reference honours what stands in place of the materials' word
        render(scenes / "fresnel.json", truth, "-m", "fresnel=schlick", "--device", "reference")
        turner("compare", picture, truth, "-t", 1e-4, "-r", 1e-3, "-n", "0.1%")

        run = turner("render", scenes / "mesh.json", "-o", picture, "-m", "precision=f64",
                     "--traversal", "ray_query", status=2)
        if "bvh" not in run.stderr:
            failures.append(f"ray queries in f64: {run.stderr}")
    print("\n".join(failures) or "all methods do what they say")
    return 1 if failures else 0


sys.exit(main())
