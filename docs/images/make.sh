#!/bin/sh
# Makes the pictures of README.md and docs/gallery.md: docs/images/make.sh TURNER
set -eu
turner=$1
cd "$(dirname "$0")"
"$turner" render ../../scenes/whitted1980.json --quiet --size 800x600 --spp 16 -o whitted1980.png
for scene in ../../scenes/*.json; do
    name=$(basename "$scene" .json)
    [ "$name" != schema ] || continue
    size=$("$turner" render "$scene" --print-settings |
           sed -n 's/.*"size":[^0-9]*\([0-9]*\)[^0-9]*\([0-9]*\).*/\1 \2/p')
    "$turner" render "$scene" --quiet --size "320x$((320 * ${size#* } / ${size% *}))" --spp 16 \
        -o "$name.jpg"
done
"$turner" render ../../scenes/shadows.json --quiet --size 320x240 --spp 16 --shadows opaque \
    -o shadows-opaque.jpg
for scene in marble blinn toon; do
    "$turner" render ../../shaders/examples/$scene.json --quiet --size 320x240 --spp 16 \
        -o shader-$scene.jpg
done
