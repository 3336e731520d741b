#!/usr/bin/env bash
# walk.sh's quick form: a walk through a small room flickers no more than its noise says, path traced or by a kept
# photon map; a frame that is brighter than the others is found out.
set -euo pipefail
# shellcheck source=tests/fixtures/shell_test.sh
source "$(dirname "${BASH_SOURCE[0]}")/../fixtures/shell_test.sh"
need jq python3 oiiotool
export AG_BUILD_DIR=$folder/build AG_PROGRAM=$AFTERGLOW_PROGRAM AG_PERF_BUILD=no
mkdir -p "$AG_BUILD_DIR"
ln -s "$AFTERGLOW_BUILD_DIR/bin" "$AG_BUILD_DIR/bin"
holds() { awk "BEGIN { exit !($1) }" || fail "$2: $1"; }

box=$root/tests/scenes/box_with_blocks.pbrt
"$root/perf/scripts/walk.sh" --quick --out "$folder/out" "$box" >"$folder/said" || fail "it ended with $?"
cat "$folder/out/walk.csv"
figure() { jq -r --arg kind "$1" --arg column "$2" '.[] | select(.kind == $kind) | .[$column]' "$folder/out/walk.json"; }
for kind in kept new path; do
    holds "$(figure $kind pixels) > 1000" "pixels compared, $kind"
done
# Stratified samples are quieter than their variances say; 1.5 is far above what 3 frames scatter.
for kind in kept path; do
    holds "$(figure $kind pixel_ratio) > 0.02 && $(figure $kind pixel_ratio) < 1.5" "noise of pixels, $kind"
    holds "$(figure $kind block_ratio) > 0.02 && $(figure $kind block_ratio) < 1.5" "noise of blocks, $kind"
done

# a frame that is half as bright again
frame() { # FILE
    "$AFTERGLOW_PROGRAM" -q --noise 0 --spp 4 --size 64x36 --only indirect --type float --aov P --aov variance -o "$1" "$box"
}
frame "$folder/a.exr"
oiiotool "$folder/a.exr" --mulc 1.5,1.5,1.5,1,1,1,1,1,1 -d float -o "$folder/b.exr"
IFS=, read -r pixels pixel_ratio block_ratio < <(python3 "$root/perf/scripts/walk.py" flicker "$folder/a.exr" "$folder/b.exr")
holds "$pixels > 1000 && $pixel_ratio > 2 && $block_ratio > 20" "a flash in blocks, $pixels, $pixel_ratio, $block_ratio"

status=0
"$root/perf/scripts/walk.sh" --kinds nothing "$box" 2>"$folder/said" || status=$?
((status == 1)) && grep -q "some of kept, new, path" "$folder/said" || fail "an unknown kind: $status, $(cat "$folder/said")"
status=0
python3 "$root/perf/scripts/walk.py" flicker "$box" "$box" 2>"$folder/said" || status=$?
((status == 1)) && grep -q "is no EXR file" "$folder/said" || fail "a file that is no EXR: $status, $(cat "$folder/said")"
