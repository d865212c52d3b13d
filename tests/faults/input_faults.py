"""Scenes that are wrong: each message points at the place."""

import os

from harness import BAD_INPUT, CAMERA, Skip, as_nobody, fault, require


def json_fault(name, text, message):
    """A scene that is refused. '@' in `text` marks the place the message must point at."""
    def check(place):
        offset = text.index("@")
        line = text.count("\n", 0, offset) + 1
        column = offset - (text.rfind("\n", 0, offset) + 1) + 1
        place.write("wrong.json", text.replace("@", ""))
        place.refuses(BAD_INPUT, f"turner: error: wrong.json:{line}:{column}: {message}\n",
                      "render", "wrong.json", "-o", "picture.png")
    fault(check, name="json_" + name)


def scene(rest, camera=CAMERA):
    return '{\n  "version": 1,\n  %s,\n  %s\n}\n' % (camera, rest)


SPHERE = '"type": "sphere", "center": [0, 0, 0], '
MATERIAL = '"materials": {"grey": {"k_d": 0.5}}, '

json_fault("not_json", "@hello", '"hello" is no JSON value; text wants double quotes')
json_fault("truncated", scene('"primitives": [').rstrip("}\n") + "@",
           'the file ends here, but the "[" of line 4, column 17 is not closed; it may be truncated')
json_fault("comma_too_many", scene('"ambient": 1,@,'), 'expected a key, but here is ","')
json_fault("comment", scene('@// a remark\n  "ambient": 1'),
           'JSON has no comments; use "description" instead')
json_fault("list_instead", "@[]", "expected an object, but here is a list (at $)")
json_fault("unknown_key", scene('@"primitivs": []'),
           'unknown key "primitivs", did you mean "primitives"? (at $.primitivs)')
json_fault("unknown_key_inside", scene(MATERIAL + '"primitives": [{' + SPHERE +
                                       '"radius": 1, "material": "grey", @"colour": 1}]'),
           'unknown key "colour"; known for a sphere: "type", "material", "center", "radius" '
           "(at $.primitives[0].colour)")
json_fault("doubled_key", scene('"ambient": 1,\n  @"ambient": 1'),
           'the key "ambient" is here twice (at $.ambient)')
json_fault("missing_key", '@{"version": 1}', 'missing key "camera" of a scene (at $)')
json_fault("other_version", '{"version": @2, %s}' % CAMERA,
           "version 2 is not known; this turner reads version 1 (at $.version)")
json_fault("wrong_type", scene('"ambient": @true'),
           'expected a colour (a number, [r, g, b] or "#rrggbb"), but here is true (at $.ambient)')
json_fault("wrong_colour", scene('"background": @"#12345"'),
           'expected a colour (a number, [r, g, b] or "#rrggbb"), but here is "#12345" '
           "(at $.background)")
json_fault("out_of_range", scene(MATERIAL + '"primitives": [{' + SPHERE +
                                 '"radius": @-1, "material": "grey"}]'),
           "expected a number above 0, but here is -1 (at $.primitives[0].radius)")
json_fault("not_finite", scene('"ambient": @1e999'),
           "this number is too large; 3.4e38 is the limit (at $.ambient)")
json_fault("nan", scene('"ambient": @NaN'),
           '"NaN" is no JSON value; text wants double quotes')
json_fault("wrong_choice", scene('"settings": {"shading": @"fong"}'),
           'expected "phong" or "energy_conserving", but here is "fong" '
           "(at $.settings.shading)")
json_fault("unknown_name", scene(MATERIAL + '"primitives": [{' + SPHERE +
                                 '"radius": 1, "material": @"gray"}]'),
           'no material named "gray"; did you mean "grey"? (at $.primitives[0].material)')
json_fault("camera_nowhere", scene('"ambient": 0', '"camera": {"from": [1, 2, 3], '
                                                   '"at": @[1, 2, 3]}'),
           '"at" is where "from" is; the camera has no direction (at $.camera.at)')
json_fault("no_pixels", scene('"settings": {"size": [@0, 0]}'),
           "expected an integer from 1 to 65536, but here is 0 (at $.settings.size[0])")
json_fault("depth_too_large", scene('"settings": {"depth": @1025}'),
           "expected an integer from 0 to 1024, but here is 1025 (at $.settings.depth)")
json_fault("index_out_of_range", scene(
    MATERIAL + '"primitives": [{"type": "mesh", "material": "grey", "positions": '
    '[[0, 0, 0], [1, 0, 0], [0, 1, 0]], "triangles": [[0, 1, @3]]}]'),
    "expected an integer from 0 to 2, but here is 3 (at $.primitives[0].triangles[0][2])")
json_fault("missing_texture", scene(
    '"materials": {"grey": {"k_d": 1, "pattern": {"type": "image", "file": @"no.png"}}}'),
    "cannot read picture no.png: No such file or directory; check its name "
    "(at $.materials.grey.pattern.file)")
json_fault("missing_environment", scene('"background": {"type": "environment", "file": @"no.hdr"}'),
           "cannot read picture no.hdr: No such file or directory; check its name "
           "(at $.background.file)")
json_fault("missing_mesh", scene('"meshes": {"bunny": {"file": @"no.ply"}}'),
           "no.ply: cannot open the mesh: No such file or directory (at $.meshes.bunny.file)")


@fault
def json_texture_is_text(place):
    place.write("text.png", "this is no picture")
    place.write("wrong.json", scene(
        '"materials": {"m": {"k_d": 1, "pattern": {"type": "image", "file": "text.png"}}}'))
    place.refuses(BAD_INPUT, ["wrong.json:4:", "text.png", "(at $.materials.m.pattern.file)"],
                  "render", "wrong.json", "-o", "picture.png")


@fault
def json_nested_deeply(place):
    """32 levels are allowed, and depth far beyond costs no stack."""
    for depth in (33, 1_000_000):
        place.write("wrong.json", "[" * depth + "]" * depth)
        place.refuses(BAD_INPUT, "wrong.json:1:33: nested more than 32 deep",
                      "render", "wrong.json", "-o", "picture.png")


# ---- limits of docs/scenes.md: at the limit all is well, one more is refused ----

def limit_fault(name, limit, message, text_of):
    def check(place):
        place.write("limit.json", text_of(limit))
        place.succeeds("check", "-q", "limit.json")
        place.write("limit.json", text_of(limit + 1))
        place.refuses(BAD_INPUT, ["limit.json:", message], "render", "limit.json", "-o", "p.png")
    fault(check, name="limit_" + name)


def many(text, count):
    return ", ".join(text.replace("#", str(i)) for i in range(count))


limit_fault("planes", 64, "one plane too many; 64 are the limit", lambda n: scene(
    MATERIAL + '"primitives": [' + many('{"type": "plane", "point": [0, #, 0], "normal": '
                                        '[0, 1, 0], "material": "grey"}', n) + "]"))
limit_fault("media", 255, "but 255 are the limit", lambda n: scene(
    '"media": {' + many('"m#": {"index": 1.5}', n) + "}"))
limit_fault("lights", 4096, "but 4096 are the limit", lambda n: scene(
    '"lights": [' + many('{"type": "point", "position": [0, #, 0], "intensity": 1}', n) + "]"))
limit_fault("materials", 1 << 20, "but 1048576 are the limit", lambda n: scene(
    '"materials": {' + many('"#": {}', n) + "}"))
limit_fault("names", 255, "this name has 256 bytes, but 255 are the limit", lambda n: scene(
    '"materials": {"' + "x" * n + '": {}}'))
limit_fault("depth_of_branches", 64, "depth 65 is too much where a material both reflects and "
            "transmits", lambda n: scene(
                '"settings": {"depth": %d}, "materials": {"glass": {"k_r": 1, "k_t": 1, '
                '"index": 1.5}}' % n))


@fault
def limit_file_size(place):
    with open(place.folder / "large.json", "wb") as file:
        file.truncate((1 << 30) + 1)  # takes no room on the disk
    returned, _, err = place.run("render", "large.json", "-o", "picture.png")
    require(returned == BAD_INPUT, f"exit status {returned}")
    require("large.json: the file has 1073741825 bytes, but 1073741824 are the limit" in err,
            "the message lacks the figures")
    require(sorted(os.listdir(place.folder)) == ["large.json", "scene.json"], "files left behind")


# ---- other files ----

TRUNCATED_NFF = """v
from 0 0 5
at 0 0 0
up 0 1 0
angle 40
hither 1
resolution 64 64
f 1 0 0 1 0 0 0 1
s 0 0"""


@fault
def nff_truncated(place):
    place.write("cut.nff", TRUNCATED_NFF)
    place.refuses(BAD_INPUT, "cut.nff:9:6: expected a number, z of a sphere (s), but the file ends "
                             "here", "render", "cut.nff", "-o", "picture.png")


PLY = """ply
format ascii 1.0
element vertex 3
property float x
property float y
property float z
element face 1
property list uchar int vertex_indices
end_header
0 0 0
%s 0 0
0 1 0
3 0 1 %d
"""


@fault
def mesh_with_nan(place):
    place.write("nan.ply", PLY % ("nan", 2))
    place.write("nan.obj", "v 0 0 0\nv nan 0 0\nv 0 1 0\nf 1 2 3\n")
    for name in ("nan.ply", "nan.obj"):
        place.refuses(BAD_INPUT, [f"{name}: the position of vertex 1 in mesh ",
                                  "is not a finite number; repair the file"],
                      "render", name, "-o", "picture.png")


@fault
def mesh_index_out_of_range(place):
    place.write("index.ply", PLY % ("1", 9))
    place.refuses(BAD_INPUT, ["index.ply: a face of mesh ", "uses vertex 9 (counted from 0), but "
                              "there are only 3; repair the file"],
                  "render", "index.ply", "-o", "picture.png")
    place.write("index.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 7\n")
    place.refuses(BAD_INPUT, "index.obj: ", "render", "index.obj", "-o", "picture.png")


@fault
def mesh_truncated(place):
    whole = PLY % ("1", 2)
    place.write("cut.ply", whole[:whole.index("0 1 0\n3")])
    place.refuses(BAD_INPUT, "cut.ply", "render", "cut.ply", "-o", "picture.png")


@fault
def mesh_named_in_scene_is_wrong(place):
    """The message names both the mesh file and the place in the scene that asked for it."""
    place.write("nan.ply", PLY % ("nan", 2))
    place.write("wrong.json", scene('"meshes": {"bunny": {"file": "nan.ply"}}'))
    place.refuses(BAD_INPUT, ["wrong.json:4:32: nan.ply: ", "is not a finite number",
                              "(at $.meshes.bunny.file)"],
                  "render", "wrong.json", "-o", "picture.png")


@fault
def scene_missing(place):
    place.refuses(BAD_INPUT, "no.json: cannot be opened: No such file or directory",
                  "render", "no.json", "-o", "picture.png")


@fault
def scene_is_folder(place):
    (place.folder / "folder.json").mkdir()
    place.refuses(BAD_INPUT, "folder.json: is a folder; give a scene file in it",
                  "render", "folder.json", "-o", "picture.png")


@fault
def scene_is_empty(place):
    for ending in ("json", "nff", "ply"):
        name = place.write("empty." + ending, "")
        place.refuses(BAD_INPUT, f"{name}: the file is empty", "render", name, "-o", "picture.png")


@fault
def scene_of_unknown_kind(place):
    place.write("scene.xyz", "hello")
    place.refuses(BAD_INPUT, "scene.xyz: unknown kind of scene; its name must end in one of .json, "
                             ".nff, .obj, .ply, .stl, .gltf and .glb",
                  "render", "scene.xyz", "-o", "picture.png")


@fault
def scene_is_pipe(place):
    """A scene that never ends is not waited for."""
    os.mkfifo(place.folder / "pipe.json")
    returned, _, err = place.run("render", "pipe.json", "-o", "picture.png", timeout=20)
    require(returned == BAD_INPUT and "pipe.json: is not a regular file" in err, "wrong message")


@fault
def scene_unreadable(place):
    options = as_nobody(place)
    path = place.folder / "scene.json"
    place.folder.chmod(0o777)
    path.chmod(0o200)
    if not options and os.access(path, os.R_OK):
        raise Skip("this user may read everything")
    returned, _, err = place.run("render", "scene.json", "-o", "picture.png", **options)
    require(returned == BAD_INPUT, f"exit status {returned}")
    require("scene.json: cannot be opened: Permission denied" in err, "wrong message")
    require(not list(place.folder.glob("picture*")), "files left behind")


@fault
def check_says_which(place):
    """Of several files each wrong one is named; the right ones do not hide it."""
    place.write("wrong.json", "{")
    returned, out, err = place.run("check", "wrong.json", "scene.json", "no.json")
    require(returned == BAD_INPUT, f"exit status {returned}")
    require(err.count("turner: error: ") == 2, "not one error for each wrong file")
    require("wrong.json:1:2" in err and "no.json: cannot be opened" in err, "a file is not named")
    require("scene.json: 0 spheres" in out, "the right scene is not described")
