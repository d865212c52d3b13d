#!/bin/sh
# Makes the golden pictures with the reference tracer: tests/golden/make.sh TURNER [NAME…]
# They are the truth of tests to come, so look at each before you commit it.
set -eu
turner=$1
shift
folder=$(cd "$(dirname "$0")" && pwd)
scenes=$folder/../../scenes
[ $# -gt 0 ] || set -- $(cd "$scenes" && ls -- *.json | sed 's/\.json$//' | grep -vx schema)
for name; do
    size=$("$turner" render "$scenes/$name.json" --print-settings |
           sed -n 's/.*"size":[^0-9]*\([0-9]*\)[^0-9]*\([0-9]*\).*/\1 \2/p')
    [ -n "$size" ] || { printf '%s: no size\n' "$name" >&2; exit 1; }
    height=$((160 * ${size#* } / ${size% *}))
    "$turner" render "$scenes/$name.json" --device reference --size "160x$height" --spp 1 \
        --quiet -o "$folder/$name.png"
    printf '%s.png 160x%d\n' "$name" "$height"
done
