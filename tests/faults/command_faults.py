"""Wrong command lines: exit status 2, and the option with its range."""

from harness import USAGE, fault


def option_fault(name, message, *arguments):
    def check(place):
        place.refuses(USAGE, message, *arguments)
    fault(check, name="option_" + name)


def render_fault(name, message, *options):
    option_fault(name, message, "render", "scene.json", "-o", "picture.png", *options)


SIZE = "--size takes WIDTHxHEIGHT, both from 1 to 65536, as in 640x480, not "
for case, size in {"no_pixels": "0x0", "negative": "-5x5", "too_large": "65537x1", "half": "640",
                   "three": "1x2x3", "text": "large", "overflow": "99999999999999999999x1"}.items():
    render_fault("size_" + case, f'{SIZE}"{size}"', f"--size={size}")
render_fault("depth_too_large", '--depth takes a whole number from 0 to 1024, not "1025"',
             "--depth", "1025")
render_fault("depth_fraction", '--depth takes a whole number from 0 to 1024, not "1.5"',
             "--depth", "1.5")
render_fault("depth_empty", '--depth takes a whole number from 0 to 1024, not ""', "--depth", "")
render_fault("cutoff_nan", '--cutoff takes a number from 0 to 1, not "nan"', "--cutoff", "nan")
render_fault("cutoff_negative", '--cutoff takes a number from 0 to 1, not "-1"', "--cutoff=-1")
render_fault("spp_none", '--spp takes a whole number from 1 to 65536, not "0"', "--spp", "0")
render_fault("exposure", '--exposure takes a number from -64 to 64, not "inf"',
             "--exposure", "inf")
render_fault("tile", '--tile takes a whole number from 1 to 4096, not "0"', "--tile", "0")
render_fault("threads", '--threads takes a whole number from 1 to 1024, not "0"',
             "--threads", "0")
render_fault("shading", '--shading takes one of phong, energy_conserving, not "fong"',
             "--shading", "fong")
render_fault("shadows", '--shadows takes one of opaque, tinted, not "soft"', "--shadows", "soft")
render_fault("transfer", '--transfer takes one of srgb, linear, not "gamma"',
             "--transfer", "gamma")
render_fault("traversal", '--traversal takes one of auto, bvh, ray_query, bvh_lane, bvh_packet, not "fast"',
             "--traversal", "fast")
render_fault("unknown", 'option "--sise=1x1" is unknown or lacks its value; see turner render '
             "--help", "--sise=1x1")
render_fault("unknown_letter", 'option "-x" is unknown or lacks its value', "-xq")
render_fault("without_value", 'option "--depth" is unknown or lacks its value', "--depth")
render_fault("two_scenes", "render takes one scene; see turner render --help", "scene.json")
option_fault("no_scene", "render takes one scene", "render", "-o", "picture.png")
option_fault("no_output", "say where the picture goes: -o picture.png", "render", "scene.json")
option_fault("no_such_command", 'no command "rendr"; see turner --help', "rendr", "scene.json")
option_fault("check_nothing", "check takes scenes or shaders", "check")
option_fault("devices_argument", 'devices takes no argument ("gpu")', "devices", "gpu")
option_fault("compare_one", "", "compare", "picture.png")
