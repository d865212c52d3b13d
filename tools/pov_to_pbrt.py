#!/usr/bin/env python3
"""Turns what `turner export --pov` has made of an NFF file into a scene for pbrt-v3, to compare times.

The rays are the same: whitted integrator, one sample in each pixel's centre, as many bounces. The
shading is pbrt's own and cheaper: no highlights, lights whose strength falls off, no background but
black. Cones are a ValueError.

Example: tools/pov_to_pbrt.py balls.nff balls.pov balls.pbrt --size 512 --depth 4
"""
import argparse
import math
import re

NUMBER = r"[-+0-9.eE]+"
VECTOR = rf"<({NUMBER}), ({NUMBER}), ({NUMBER})>"


def camera_and_lights(out, lines):
    words = [line.split() for line in lines]
    view = {word[0]: [float(x) for x in word[1:]] for word in words
            if word and word[0] in ("from", "at", "up", "angle")}
    numbers = {key: " ".join(map(repr, value)) for key, value in view.items()}
    out.append(f"Scale -1 1 1\nLookAt {numbers['from']}  {numbers['at']}  {numbers['up']}\n"
               f'Camera "perspective" "float fov" [{numbers["angle"]}]\nWorldBegin')
    lights = [[float(x) for x in word[1:4]] for word in words if word[:1] == ["l"]]
    for light in lights:
        strength = math.pi * math.dist(light, view["at"]) ** 2 / math.sqrt(len(lights))
        place = " ".join(map(repr, light))
        out.append(f'LightSource "point" "point from" [{place}] "rgb I" [{(repr(strength) + " ") * 3}]')


def material(fill):
    r, g, b, k_d, k_s, _, k_t, index = map(float, fill)
    diffuse = " ".join(repr(k_d * x) for x in (r, g, b))
    return (f'Material "uber" "rgb Kd" [{diffuse}] "rgb Ks" [0 0 0] "rgb Kr" [{k_s} {k_s} {k_s}] '
            f'"rgb Kt" [{k_t} {k_t} {k_t}] "float eta" [{index if index > 1 else 1.5}]')


def vectors(text, name):
    """The block `name { count, <x, y, z>, … }` as numbers."""
    block = re.search(rf"{name} {{ \d+,(.*?)}}", text, re.S)
    return " ".join(" ".join(v) for v in re.findall(VECTOR, block[1])) if block else ""


def shapes(out, pov, materials):
    pattern = re.compile(r"^(sphere|mesh2|cone) {(.*?)texture { M(\d+) }", re.S | re.M)
    # things that only throw shadows stand there a second time, without a texture
    pov = re.sub(r"^(sphere|mesh2) {(?:(?!\n(?:sphere|mesh2) {|texture).)*?no_image.*?}$", "", pov,
                 flags=re.S | re.M)
    for kind, body, number in pattern.findall(pov):
        out.append(materials[int(number)])
        if kind == "cone":
            raise ValueError("cones are not converted")
        if kind == "sphere":
            x, y, z = re.search(VECTOR, body).groups()
            radius = re.search(rf">, ({NUMBER})", body)[1]
            out.append(f"AttributeBegin\nTranslate {x} {y} {z}\n"
                       f'Shape "sphere" "float radius" [{radius}]\nAttributeEnd')
        else:
            normals = vectors(body, "normal_vectors")
            out.append(f'Shape "trianglemesh" "point P" [{vectors(body, "vertex_vectors")}] '
                       + (f'"normal N" [{normals}] ' if normals else "")
                       + f'"integer indices" [{vectors(body, "face_indices")}]')


def convert(nff, pov, picture, size, depth):
    with open(nff, encoding="ascii") as file:
        lines = file.read().splitlines()
    with open(pov, encoding="utf-8") as file:
        text = file.read()
    out = [f'Film "image" "integer xresolution" [{size}] "integer yresolution" [{size}] '
           f'"string filename" ["{picture}"]\nPixelFilter "box"\n'
           'Sampler "stratified" "integer xsamples" [1] "integer ysamples" [1] '
           '"bool jitter" ["false"]\n'
           f'Integrator "whitted" "integer maxdepth" [{depth + 1}]']
    camera_and_lights(out, lines)
    fills = [line.split()[1:] for line in lines if line.split()[:1] == ["f"]]
    shapes(out, text, [material(fill) for fill in fills])
    return "\n".join(out + ["WorldEnd", ""])


def main():
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("nff")
    parser.add_argument("pov")
    parser.add_argument("pbrt", help="file to write; its picture will be FILE.exr")
    parser.add_argument("--size", type=int, default=512, help="width and height (512)")
    parser.add_argument("--depth", type=int, default=4, help="bounces (4)")
    arguments = parser.parse_args()
    text = convert(arguments.nff, arguments.pov, arguments.pbrt + ".exr", arguments.size,
                   arguments.depth)
    with open(arguments.pbrt, "w", encoding="ascii") as file:
        file.write(text)


if __name__ == "__main__":
    main()
