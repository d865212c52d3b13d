"""command_output.py files | stats | nonfinite: what `turner render` leaves behind.

Environment: TURNER, the command. Exit status 77 without a Vulkan device.
"""

import json
import os
import pathlib
import subprocess
import sys
import tempfile

TURNER = os.environ["TURNER"]
SCENE = """{"version": 1, "camera": {"from": [0, 1, 5], "at": [0, 0, 0]},
 "background": 0.5, "settings": {"size": [40, 30], "spp": 2, "depth": 5},
 "materials": {"glass": {"k_r": 1, "k_t": 1, "index": 1.5}, "grey": {"k_d": 0.5}},
 "primitives": [
  {"type": "sphere", "center": [0, 0, 0], "radius": 1, "material": "glass"},
  {"type": "box", "min": [-3, -2, -2], "max": [3, -1, 1], "material": "grey"}],
 "lights": [{"type": "point", "position": [2, 4, 3], "intensity": %s}]}"""


def turner(*arguments):
    print("$ turner", *arguments)
    done = subprocess.run([TURNER, *arguments], capture_output=True, text=True, timeout=300)
    print(done.stdout[:2000], done.stderr, "=>", done.returncode, sep="")
    assert done.returncode == 0, "it failed"
    return done


def files():
    """Two runs write the same bytes, in every format, whatever the time and the file's name."""
    pathlib.Path("scene.json").write_text(SCENE % 30)
    for device in ([], ["--traversal", "bvh"], ["--device", "reference"]):
        for ending in ("png", "16.png", "exr", "hdr", "tif", "jpg", "ppm"):
            if device and ending not in ("png", "exr"):
                continue
            for name in ("first", "second"):
                turner("render", "scene.json", "-o", f"{name}.{ending}", "-q", *device)
            first, second = (pathlib.Path(f"{name}.{ending}").read_bytes()
                             for name in ("first", "second"))
            assert first == second, f"two .{ending} files differ"
            assert len(first) > 200, "that is no picture"


def number(value, least=0):
    return isinstance(value, (int, float)) and not isinstance(value, bool) and value >= least


def stats():
    """Every field is there and says something that can be true."""
    pathlib.Path("scene.json").write_text(SCENE % 30)
    for options in ([], ["--device", "reference"]):
        out = turner("render", "scene.json", "-o", "p.png", "--stats", "-", *options).stdout
        turner("render", "scene.json", "-o", "p.png", "--stats", "s.json", *options)
        s = json.loads(out)  # nothing else goes to stdout then
        in_file = json.loads(pathlib.Path("s.json").read_text())
        assert s.keys() == in_file.keys() and s["rays"] == in_file["rays"], "file and stdout differ"

        reference = bool(options)
        assert s["device"] and (reference or s["driver"]), "no device or driver"
        assert s["traversal"] == "reference" if reference else s["traversal"] in (
            "bvh_lane", "bvh_packet", "ray_query"), "traversal"
        assert s["precision"] == ("extended" if reference else "f32"), "precision"
        settings = s["settings"]
        assert settings.pop("methods") == {
            "sphere": "robust", "triangle": "watertight", "offset": "error_bound",
            "fresnel_cosine": "stable", "fresnel": "material", "schlick_side": "transmitted",
            "precision": "f32", "aa": "2", "traversal": "auto"}, "methods"
        assert settings == {
            "size": [40, 30], "depth": 5, "cutoff": 0.001953125, "spp": 2,
            "shading": "energy_conserving", "shadows": "tinted", "exposure": 0, "transfer": "srgb",
            "spd_rays": False, "spd_grid": False}, "settings"
        rays = s["rays"]
        assert rays["camera"] == 40 * 30 * 2, "camera rays"
        assert all(number(rays[kind], 1) for kind in ("reflected", "refracted", "shadow")), "rays"
        assert 1 <= s["largest_depth"] <= 5, "largest_depth"
        assert 0 < s["pruned"]["mean"] < s["pruned"]["max"] < 1, "pruned"
        assert s["nonfinite"] == {"count": 0}, "nonfinite"
        seconds = s["seconds"]
        assert all(number(seconds[what]) for what in (
            "parse", "build", "compile", "upload", "trace", "read_back", "write")), "seconds"
        assert seconds["parse"] > 0 and seconds["trace"] > 0 and seconds["write"] > 0, "seconds"
        assert reference or seconds["compile"] > 0 and seconds["upload"] > 0, "seconds"
        assert seconds["start"] > 0, "seconds"
        assert seconds["whole"] > seconds["start"] + seconds["trace"] + seconds["write"], "seconds"
        assert sorted(s["cached"]) == ["driver", "kernel", "source"], "cached"
        assert not (reference and any(s["cached"].values())), "nothing to compile"
        assert s["peak_bytes"]["host"] > 1e6, "peak_bytes.host"
        assert reference or s["peak_bytes"]["device"] > 40 * 30 * 16, "peak_bytes.device"
        if not reference:
            wanted = {"spheres", "triangles", "point lights", "reflection", "transmission"}
            assert wanted <= set(s["features"]), "features"
            assert "cones" not in s["features"] and "metals" not in s["features"], "features"


def nonfinite():
    """Pixels that are not finite are counted and reported with a place, never silent."""
    scene = json.loads(SCENE % 30)
    scene["materials"]["grey"] |= {"k_e": 3e38, "k_a": 1}  # twice 3e38 is beyond a float
    scene["ambient"] = 3e38
    pathlib.Path("scene.json").write_text(json.dumps(scene))
    for options in ([], ["--device", "reference"]):
        done = turner("render", "scene.json", "-o", "p.exr", "--stats", "-", *options)
        s = json.loads(done.stdout)["nonfinite"]
        assert s["count"] > 0, "no pixel is infinite"
        x, y = s["first"]
        assert 0 <= x < 40 and 0 <= y < 30, "no such pixel"
        assert f"turner: warning: {s['count']} pixel" in done.stderr and f"{x},{y}" in done.stderr


def main():
    probe = subprocess.run([TURNER, "devices"], capture_output=True, text=True)
    if probe.returncode != 0 or "bvh         yes" not in probe.stdout:
        print("skipped:", probe.stderr.strip() or "no Vulkan device has what turner requires")
        sys.exit(77)
    with tempfile.TemporaryDirectory(prefix="turner-output-") as folder:
        os.chdir(folder)
        {"files": files, "stats": stats, "nonfinite": nonfinite}[sys.argv[1]]()
        os.chdir("/")


main()
