#!/usr/bin/env bash
# The Blender add-on, from its .zip: rooms are as bright as in Cycles (means within 2 % where surfaces are Lambertian,
# within 5 % elsewhere), pictures have the same bits twice, passes are Cycles', Ctrl-C cancels, frames follow one
# another. Skipped where Blender 3.4 (with numpy) is not installed, and in builds with sanitizers, which a program
# that was built without them cannot load.
# ctest: blender
set -euo pipefail
# shellcheck source=tests/fixtures/shell_test.sh
source "$(dirname "${BASH_SOURCE[0]}")/../fixtures/shell_test.sh"
need blender oiiotool
# shellcheck source=tests/fixtures/blender_test.sh
source "$(dirname "${BASH_SOURCE[0]}")/../fixtures/blender_test.sh"

timeout 1500 blender -b --factory-startup --python-exit-code 1 -P "$root/tests/fixtures/blender_addon.py" -- \
    "$AFTERGLOW_BUILD_DIR/afterglow-blender.zip" "$folder" >blender.log 2>&1 || {
    tail -40 blender.log
    fail "blender ends with an error"
}
grep '^ok: \|^FAILED: \|^Warning: Afterglow\|^Error' blender.log || true
grep -q '^END$' blender.log || fail "the tests did not come to their end"
! grep -v 'on purpose' blender.log | grep '^FAILED: \|^Error: \|Traceback' >/dev/null || fail "see above"

stats() { # FILE CHANNELS: their means
    oiiotool "$1" --ch "$2" --printstats | awk '/Stats Avg/ { $1 = $2 = ""; sub(/\(float\).*/, ""); print; exit }'
}
# Depth is the nearest surface's in each pixel, in Cycles that of one sample.
for pass in Depth.Z Normal.X,ViewLayer.Normal.Y,ViewLayer.Normal.Z Position.X,ViewLayer.Position.Y,ViewLayer.Position.Z; do
    ours=$(stats AFTERGLOW.passes.exr "ViewLayer.$pass")
    cycles=$(stats CYCLES.passes.exr "ViewLayer.$pass")
    [[ -n $ours ]] || fail "there is no pass $pass"
    awk -v a="$ours" -v b="$cycles" -v most="$([[ $pass == Depth.Z ]] && echo 0.2 || echo 0.01)" 'BEGIN {
        n = split(a, x); split(b, y)
        for (i = 1; i <= n; i++) if ((x[i] - y[i]) ^ 2 > most ^ 2) exit 1 }' || fail "$pass: $ours, of Cycles $cycles"
    echo "ok: $pass: $ours, of Cycles $cycles"
done
# The parts of light are the picture; there is a pass for the lamp's group.
channels=$(oiiotool --info -v AFTERGLOW.passes.exr | sed -n '/channel list/p')
for name in Albedo Emission Direct Indirect Caustic Specular "Combined_the lamp"; do
    [[ $channels == *"ViewLayer.$name.R"* ]] || fail "there is no pass $name: $channels"
done
sum=0
for name in Emission Direct Indirect Caustic Specular; do
    sum=$(awk -v s="$sum" -v x="$(stats AFTERGLOW.passes.exr "ViewLayer.$name.R")" 'BEGIN { print s + x }')
done
whole=$(stats AFTERGLOW.passes.exr ViewLayer.Combined.R)
awk -v s="$sum" -v w="$whole" 'BEGIN { exit !(w > 0 && (s / w - 1) ^ 2 < 1e-8) }' || fail "parts of light: $sum, in all $whole"
echo "ok: passes"
