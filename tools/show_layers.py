#!/usr/bin/env python3
"""Shows layers of a picture side by side: tools/show_layers.py PICTURE.exr -o SHEET.png [LAYER…]

PICTURE is what `turner render SCENE -o PICTURE.exr --aov LAYERS` writes; all its layers are shown
unless some are named. Normals are shown as (n + 1) / 2, ids each in a colour of its own, everything
else of one channel from its least to its largest finite value. Needs numpy and matplotlib.
"""

import argparse
import os
import sys

import matplotlib
import numpy

matplotlib.use("Agg")
import matplotlib.pyplot  # noqa: E402

sys.dont_write_bytecode = True
sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
import exr  # noqa: E402


def srgb(v):
    v = numpy.clip(numpy.nan_to_num(v), 0, 1)
    return numpy.where(v <= 0.0031308, 12.92 * v, 1.055 * v ** (1 / 2.4) - 0.055)


def layers_of(picture):
    """{layer: array height × width × channels}; "picture" is RGB itself."""
    names = {}
    for name in picture.channels:  # in the file they are in alphabetic order
        names.setdefault(name.rpartition(".")[0] or "picture", []).append(name)
    names["picture"] = ["R", "G", "B"]
    if "albedo" in names:
        names["albedo"] = ["albedo.R", "albedo.G", "albedo.B"]
    shape = picture.height, picture.width
    return {layer: numpy.stack([numpy.array(picture.channels[n]).reshape(shape) for n in channels],
                               axis=-1)
            for layer, channels in names.items()}


def colours_of_ids(ids):
    """The background black, neighbouring numbers in colours far apart (the golden angle)."""
    hue = ids * 0.618033988749895 % 1
    hsv = numpy.stack([hue, 0.55 + 0.4 * (ids % 3 == 1), 0.95 - 0.25 * (ids % 2)], axis=-1)
    rgb = matplotlib.colors.hsv_to_rgb(hsv)
    rgb[ids == 0] = 0
    return rgb


def show(figure, axes, layer, values):
    if layer in ("picture", "albedo"):
        axes.imshow(srgb(values))
    elif layer == "normal":
        axes.imshow(numpy.where(numpy.any(values != 0, axis=-1, keepdims=True),
                                (values + 1) / 2, 0))
    elif layer == "position":
        size = numpy.abs(values).max() or 1
        axes.imshow(numpy.where(numpy.any(values != 0, axis=-1, keepdims=True),
                                (values / size + 1) / 2, 0))
    elif layer == "id":
        axes.imshow(colours_of_ids(values[..., 0].astype(float)))
    else:
        plane = values[..., 0].astype(float)
        image = axes.imshow(numpy.where(numpy.isfinite(plane), plane, numpy.nan), cmap="viridis")
        figure.colorbar(image, ax=axes, fraction=0.035, pad=0.02).ax.tick_params(labelsize=7)
    axes.set_title(layer, fontsize=10)


def main():
    parser = argparse.ArgumentParser(description=__doc__,
                                     formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("picture", metavar="PICTURE.exr")
    parser.add_argument("layers", nargs="*", metavar="LAYER")
    parser.add_argument("-o", "--output", required=True, metavar="SHEET.png")
    arguments = parser.parse_args()
    found = layers_of(exr.read(arguments.picture))
    wanted = arguments.layers or list(found)
    for layer in wanted:
        if layer not in found:
            sys.exit(f"{arguments.picture} has no layer {layer}; it has {', '.join(found)}")
    columns = min(3, len(wanted))
    rows = -(-len(wanted) // columns)
    height, width = found["picture"].shape[:2]
    figure, grid = matplotlib.pyplot.subplots(
        rows, columns, squeeze=False, figsize=(3.4 * columns, (3.1 * height / width + 0.35) * rows))
    for axes in grid.flat:
        axes.axis("off")
    for axes, layer in zip(grid.flat, wanted):
        show(figure, axes, layer, found[layer])
    figure.tight_layout(pad=0.4)
    figure.savefig(arguments.output, dpi=110, metadata={"Software": None})


main()
