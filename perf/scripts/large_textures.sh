#!/usr/bin/env bash
# large_textures.sh [COUNT [SIDE [SIZE]]]: a picture of so many textures (64) of SIDE x SIDE pixels (8192) with
# --texture-memory SIZE (1536M): peak memory, CPU and elapsed time of a first run, which makes their tiles and levels in
# a folder, and of a second one, which finds them; and before that one texture alone on one thread, three times in turn
# with maketx. The textures are slopes with noise in three channels of 8 bits, files of the same pixels and other bytes;
# 64 of 8192 x 8192 take 25 GB of $TMPDIR. $AFTERGLOW is the program (build/release/bin/afterglow). Needs oiiotool,
# maketx, jq and GNU time.
set -euo pipefail
count=${1:-64} side=${2:-8192} size=${3:-1536M}
root=$(cd "$(dirname "$0")/../.." && pwd)
program=${AFTERGLOW:-$root/build/release/bin/afterglow}
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$folder"

oiiotool --pattern "fill:topleft=.2,.3,.4:topright=.8,.7,.3:bottomleft=.5,.5,.5:bottomright=.3,.6,.9" \
    "${side}x$side" 3 --noise:type=gaussian:mean=0:stddev=.015 -d uint8 -o 0.png
for ((i = 1; i < count; i++)); do
    cp 0.png "$i.png"
    echo "$i" >> "$i.png" # behind the last chunk
done

# write_scene COUNT
write_scene() {
    echo 'LookAt 0 0 -9  0 0 0  0 1 0 Camera "perspective" "float fov" 60'
    echo 'Film "rgb" "integer xresolution" 320 "integer yresolution" 320 WorldBegin LightSource "infinite"'
    for ((i = 0; i < $1; i++)); do
        column=$((i % 8)) row=$((i / 8))
        echo "AttributeBegin Translate $((column * 12 - 42))e-1 $((row * 12 - 42))e-1 0"
        echo "Texture \"t$i\" \"spectrum\" \"imagemap\" \"string filename\" \"$i.png\""
        echo "Material \"diffuse\" \"texture reflectance\" \"t$i\""
        echo 'Shape "bilinearmesh" "point3 P" [-.55 -.55 0 .55 -.55 0 -.55 .55 0 .55 .55 0] "point2 uv" [0 0 1 0 0 1 1 1]'
        echo 'AttributeEnd'
    done
}
write_scene 1 > one.pbrt
write_scene "$count" > all.pbrt

# timed NAME COMMAND...: CPU seconds, elapsed seconds, peak memory
timed() {
    local name=$1
    shift
    command time -f '%U %S %e %M' -o time.txt "$@" > /dev/null
    awk -v name="$name" '{ printf "%-12s CPU %.2f s, elapsed %.2f s, peak %.0f MiB\n", name, $1 + $2, $3, $4 / 1024 }' time.txt
}
for ((run = 1; run <= 3; run++)); do
    rm -rf one
    timed "one texture" "$program" one.pbrt --noise 0 --spp 1 --photons 1e4 --nthreads 1 --texture-memory 16M \
        --texture-cache one -q -o one.exr
    timed "maketx" maketx --threads 1 0.png -o one.tx
done
rm -rf one one.tx
for run in first second; do
    timed "$run run" "$program" all.pbrt --noise 0 --spp 4 --photons 1e5 --gather-samples 8 --texture-memory "$size" \
        --texture-cache all -q -o picture.exr --stats picture.json
    jq -c .texture picture.json
done
