#!/usr/bin/env bash
# large_textures.sh [COUNT [SIDE [SIZE]]]: a picture of so many textures (64) of SIDE x SIDE pixels (8192) with
# --texture-memory SIZE (1G): peak memory, time, and what was read of the temporary file, which takes five bytes for each
# pixel: 21 GB for 64 textures of 8192 x 8192. $AFTERGLOW is the program (build/release/bin/afterglow). Needs oiiotool.
set -euo pipefail
count=${1:-64} side=${2:-8192} size=${3:-1G}
root=$(cd "$(dirname "$0")/../.." && pwd)
program=${AFTERGLOW:-$root/build/release/bin/afterglow}
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$folder"

oiiotool --pattern "checker:width=32:height=32:color1=.2,.3,.4:color2=.8,.7,.3" "${side}x$side" 3 -d uint8 -o 0.png
{
    echo 'LookAt 0 0 -9  0 0 0  0 1 0 Camera "perspective" "float fov" 60'
    echo 'Film "rgb" "integer xresolution" 320 "integer yresolution" 320 WorldBegin LightSource "infinite"'
    for ((i = 0; i < count; i++)); do
        ((i == 0)) || ln 0.png "$i.png"
        column=$((i % 8)) row=$((i / 8))
        echo "AttributeBegin Translate $((column * 12 - 42))e-1 $((row * 12 - 42))e-1 0"
        echo "Texture \"t$i\" \"spectrum\" \"imagemap\" \"string filename\" \"$i.png\""
        echo "Material \"diffuse\" \"texture reflectance\" \"t$i\""
        echo 'Shape "bilinearmesh" "point3 P" [-.55 -.55 0 .55 -.55 0 -.55 .55 0 .55 .55 0] "point2 uv" [0 0 1 0 0 1 1 1]'
        echo 'AttributeEnd'
    done
} > scene.pbrt
"$program" scene.pbrt --noise 0 --spp 4 --photons 1e5 --gather-samples 8 --texture-memory "$size" -q -o picture.exr \
    --stats picture.json
jq '{"memory_peak_bytes": .memory.peak_bytes, "texture": .texture, "time_s": .time_s}' picture.json
