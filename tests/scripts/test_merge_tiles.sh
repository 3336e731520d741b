#!/usr/bin/env bash
# Tiles that oiiotool adds up are the picture in one, every channel of it, with the same windows.
set -euo pipefail
# shellcheck source=tests/fixtures/shell_test.sh
source "$(dirname "${BASH_SOURCE[0]}")/../fixtures/shell_test.sh"
need oiiotool
cd "$folder"
scene=$root/tests/scenes/box_with_blocks.pbrt
render() { "$AFTERGLOW_PROGRAM" -q --size 40x30 --spp 2 --photons 3000 --gather-samples 4 --aov A,Z,albedo,light "$@" "$scene"; }

render -o whole.exr
for i in 1 2 3; do
    render --tile $i/3 -o part$i.exr
done
oiiotool part1.exr part2.exr --add part3.exr --add -o merged.exr
oiiotool --fail 0 --failpercent 0 --hardfail 0 --diff whole.exr merged.exr ||
    { echo "FAILED: the sum of the tiles is not the picture"; exit 1; }
for word in "full/display size" "pixel data origin" "channel list"; do
    # the sum is stored as floats throughout
    diff <(oiiotool --info -v whole.exr | grep "$word" | sed 's/ (half)\| (float)//g') \
        <(oiiotool --info -v merged.exr | grep "$word" | sed 's/ (half)\| (float)//g') ||
        { echo "FAILED: $word"; exit 1; }
done
