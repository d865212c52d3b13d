"""The terms of the model, a few a scene: (name, scene, pixels that may differ)."""

import math


def base(**more):
    """Looks along -z at the origin; Phong's formula, no cutoff."""
    return {"version": 1, "camera": {"from": [0, 0, 5], "at": [0, 0, 0], "vfov": 40},
            "settings": {"shading": "phong", "depth": 5, "cutoff": 0},
            "background": 0.3, "ambient": 0.25} | more


CHECKER = {"type": "checker", "colors": [[0.9, 0.2, 0.1], [0.2, 0.8, 0.5]], "scale": [3, 2]}
MATERIALS = {"grey": {"k_d": 0.5}, "shiny": {"k_d": [0, 0.4, 0.2], "k_s": 0.6, "exponent": 17},
             "checker": {"k_d": 0.7, "k_a": 0.5, "k_e": [0, 0.1, 0], "pattern": CHECKER}}
SUN = {"type": "directional", "direction": [-1, -2, -1.5], "irradiance": [1, 0.9, 0.8]}
LAMP = {"type": "point", "position": [2, 3, 4], "intensity": [12, 14, 16]}
SPOT = {"type": "spot", "position": [1, 3, 2], "at": [0, -0.5, 0], "inner": 12, "outer": 30,
        "intensity": [9, 8, 7]}


def scene_of(*primitives, materials=None, lights=(SUN,), settings=None, **more):
    scene = base(materials=MATERIALS | (materials or {}), primitives=list(primitives),
                 lights=list(lights), **more)
    scene["settings"] |= settings or {}
    return scene


def sphere(material, x=0, y=0, z=0, r=1):
    return {"type": "sphere", "center": [x, y, z], "radius": r, "material": material}


def box(material, lo, hi):
    return {"type": "box", "min": lo, "max": hi, "material": material}


def plane(material, y=-1):
    return {"type": "plane", "point": [0, y, 0], "normal": [0, 1, 0], "material": material}


def instance(group, *transform, **more):
    return {"group": group, "transform": list(transform)} | more


FLOOR = plane("grey")
BACK = {"type": "plane", "point": [0, 0, -4], "normal": [0, 0, 1], "material": "checker"}
TETRAHEDRON = {"type": "mesh", "positions": [[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1]],
               "triangles": [[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]]}


def row(materials, y=0.0, r=0.33):
    """A small sphere of each material, side by side."""
    step = 4.2 / len(materials)
    return [sphere(name, (i - (len(materials) - 1) / 2) * step, y, 0, r)
            for i, name in enumerate(materials)]


def terms():
    surfaces = {
        "diffuse": {"k_d": [0.8, 0.5, 0]},
        "emission and ambient": {"k_e": [0, 0.2, 0.3], "k_a": [0.4, 0.1, 0.9]},
        "highlight": {"k_s": 0.6, "exponent": 17, "k_d": [0, 0.4, 0.2]},
        "coloured highlight": {"k_s": [0.9, 0.3, 0], "exponent": 5.5, "k_d": 0.2,
                               "k_a": [0.5, 0, 0.1], "k_r": 0.1},
        "exponent 0": {"k_s": 0.2, "exponent": 0},
        "exponent 5000": {"k_s": 1, "exponent": 5000}}
    yield "surfaces", scene_of(*row(surfaces), FLOOR, materials=surfaces), 0
    yield "energy_conserving", scene_of(*row(["grey", "diffuse"]), FLOOR,
                                        materials={"diffuse": {"k_d": [0.9, 0.8, 0.1]}},
                                        settings={"shading": "energy_conserving"}), 0
    yield "lights", scene_of(
        sphere("shiny"), FLOOR,
        lights=[SUN, LAMP, SPOT, LAMP | {"intensity": 0.2, "falloff": "none"},
                SPOT | {"falloff": "none", "intensity": 0.5, "position": [-2, 2, 1]},
                SPOT | {"inner": 9, "outer": 9, "position": [-1, 1, 4]}]), 0
    turned = {"type": "plane", "point": [0.3, -1.1, 0.2], "normal": [0.2, 1, 0.1],
              "tangent": [1, -0.2, 0], "material": "checker"}
    yield "shapes, SPD grid", scene_of(
        {"type": "cylinder", "base": [-1.2, -1, 0], "apex": [-0.8, 0.8, 0.3], "radius": 0.5,
         "material": "shiny"},
        {"type": "cone", "base": [0.4, -1, 0], "apex": [0.6, 1, 0], "base_radius": 0.6,
         "apex_radius": 0.2, "capped": False, "material": "grey"},
        {"type": "cone", "base": [1.7, 0.8, 0], "apex": [1.7, -0.8, 0], "base_radius": 0.5,
         "material": "shiny"}, turned, settings={"spd_grid": True}), 0
    yield "meshes, checkers", scene_of(
        FLOOR, BACK, box("checker", [-1.4, -0.7, -1], [-0.3, 0.7, 0.4]),
        TETRAHEDRON | {"material": "checker"}), 0
    group = {"g": [sphere("shiny", 0.3, 0, 0, 0.5), box("grey", [-0.5, -0.5, -0.5], [0, 0, 0])]}
    yield "instances, rolled camera", scene_of(
        FLOOR, groups=group, instances=[
            instance("g", {"translate": [-1, 0, 0]}),
            instance("g", {"scale": [1, 0.5, 2]}, {"rotate": 35, "axis": [1, 2, 3]},
                     {"translate": [1, 0.4, 0]}),
            instance("g", {"scale": [-1, 1, 1]}, {"translate": [0, -0.3, 0]}, material="shiny")],
        camera={"from": [2, 1.5, 4], "at": [0.2, 0, 0.1], "up": [0.3, 1, 0.2], "vfov": 45}), 0
    mirrors = {"mirror": {"k_r": [0.9, 0.8, 0.5], "k_d": 0.1},
               "metal": {"k_r": [0.9, 0.4, 0], "fresnel": "schlick"}}
    for depth in (0, 1, 4):
        yield f"mirrors, gradient, depth {depth}", scene_of(
            sphere("mirror", -1.1), sphere("metal", 1.1), FLOOR, materials=mirrors,
            settings={"depth": depth},
            background={"type": "gradient", "bottom": [0.1, 0.6, 0], "top": [1.5, 0, 0.2],
                        "up": [math.sin(1), math.cos(1), 0.3]}), 0

    glass = {"k_r": 1, "k_t": 1, "index": 1.5}
    stained = {"k_r": 1, "k_t": [0.9, 0.6, 0.8], "index": 1.5, "absorption": [0.3, 1.2, 0.6]}
    glasses = {
        "glass": glass, "faint": glass | {"index": 1.01}, "thin": glass | {"index": 0.8},
        "air": {"k_t": [1, 0.5, 0.25], "index": 1},
        "stained": stained | {"k_s": 0.4, "exponent": 60},
        "tinted highlight": stained | {"k_s": [0.4, 0.2, 0.1], "exponent": 60},
        "milky": stained | {"k_d": [0.1, 0.2, 0], "k_e": 0.05},
        "Whitted's": {"k_r": 0.2, "k_t": 0.8, "index": 1.5, "fresnel": "none"}}
    names = list(glasses)
    for shadows in ("tinted", "opaque"):
        yield f"glasses, {shadows} shadows", scene_of(
            *row(names[:4], 0.6, 0.45), *row(names[4:], -0.5, 0.45), FLOOR, BACK,
            materials=glasses, settings={"shadows": shadows}), 0
    flat = {"g": [sphere("stained", 0, 0, 0, 0.6),
                  box("grey", [-0.5, -0.9, -0.5], [0.5, -0.7, 0.5])]}
    for shadows in ("tinted", "opaque"):
        yield f"glass instances, {shadows} shadows", scene_of(
            FLOOR, BACK, materials=glasses, groups=flat, settings={"shadows": shadows},
            instances=[instance("g", {"scale": [1, 0.6, 1.2]}, {"translate": [-1, 0, 0]}),
                       instance("g", {"rotate": 30, "axis": [0, 1, 0]},
                                {"translate": [1, 0.2, 0]})]), 0
    # Large, as POV-Ray sees nothing nearer than 1e-4, which shows along the edges of small blocks.
    far = {"camera": {"from": [0, 0, 500], "at": [0, 0, 0], "vfov": 40}}
    wall = {"type": "plane", "point": [0, -80, 0], "normal": [0, 1, 0], "material": "shiny"}
    hollow = {"stained": stained | {"absorption": [0.003, 0.012, 0.006]},
              "air": {"k_r": 1, "k_t": 0.95, "k_s": 0.3, "exponent": 40, "medium": "air"}}
    for shadows in ("tinted", "opaque"):
        yield f"hollow ball and block, {shadows} shadows", scene_of(
            wall, sphere("stained", -90, 10, 0, 100), sphere("air", -90, 10, 0, 90),
            box("stained", [40, -70, -60], [180, 60, 60]), sphere("air", 130, 0, 10, 40),
            sphere("air", 75, -40, 10, 20), materials=hollow,
            media={"air": {"index": 1, "priority": 1}}, settings={"shadows": shadows}, **far), 0
    cubes = {"exact": glass, "none": {"k_r": [0.1, 0.2, 0.3], "k_t": [0.9, 0.8, 0.7],
                                      "index": 1.5, "fresnel": "none"}, "amber": stained}
    cube = [box("exact", [-40, -40, -40], [40, 40, 40])]
    tilt = {"rotate": 40, "axis": [1, 1, 0.3]}
    yield "total reflection in cubes", scene_of(
        wall, materials=cubes, groups={"g": cube}, **far, instances=[
            instance("g", tilt, {"translate": [140 * (i - 1), 0, 0]}, material=m)
            for i, m in enumerate(cubes)]), 0
    yield "water", scene_of(plane("water", -0.5), plane("checker", -1.5),
                            materials={"water": glass | {"index": 1.333}}), 0
    water = {"k_r": 1, "k_t": 1, "medium": "water"}
    eye = {"from": [0, -1, 5], "at": [0, 0, 0], "vfov": 60, "inside": ["water"]}
    yield "under water", scene_of(
        plane("water", 0.6), plane("checker", -1.5), sphere("grey", 0, -0.6, 0, 0.7),
        materials={"water": water}, media={"water": {"index": 1.333}}, camera=eye), 0
    yield "inside a ball", scene_of(
        sphere("water", r=9), sphere("shiny"), box("checker", [-30, -30, -30], [30, 30, -20]),
        materials={"water": water},
        media={"water": {"index": 1.333, "absorption": [0.1, 0.02, 0.05]}}, camera=eye), 0
