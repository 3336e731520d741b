#!/usr/bin/env bash
# Rooms made in Blender and exported by its exporters are as bright here as in Cycles: the means of the pictures are
# within 2 % for glTF where the surfaces are the same and 10 % where its material is not quite Blender's, 12 % for FBX, and
# 18 % for Collada, where Blender writes surfaces without their highlights. What a format does not say is named in a
# warning. Skipped where Blender (with numpy, for its glTF exporter) is not installed.
# ctest: blender
set -euo pipefail
# shellcheck source=tests/fixtures/shell_test.sh
source "$(dirname "${BASH_SOURCE[0]}")/../fixtures/shell_test.sh"
need blender
cd "$folder"

if ! HOME=$folder timeout 400 blender -b --factory-startup -P "$root/tests/fixtures/blender_rooms.py" -- "$folder" \
    >blender.log 2>&1 || [[ ! -s world.cycles.exr || ! -s world.obj ]]; then
    if grep -q "No module named 'numpy'\|has no attribute 'collada_export'\|could not be found" blender.log; then
        skip "this blender lacks an exporter: $(grep -m 1 Error blender.log)"
    fi
    tail -20 blender.log
    exit 1
fi

mean() { # FILE: of the green channel
    oiiotool --stats "$1" | awk '/Stats Avg/ { print $4; exit }'
}

failures=0
expect() { # ROOM FORMAT PERCENT [OPTION...]: as bright as in Cycles; ROOM FORMAT "TEXT": not so, and told
    local room=$1 format=$2 expected=$3
    "$AFTERGLOW_PROGRAM" --type float --integrator path --noise 0 --spp 128 --size 64x36 --progress none -v "${@:4}" \
        -o "$room.$format.exr" "$room.$format" 2>"$room.$format.log" || {
        echo "FAILED: $room.$format"
        cat "$room.$format.log"
        failures=$((failures + 1))
        return
    }
    local verdict
    if [[ $expected =~ ^[0-9]+$ ]]; then
        verdict=$(awk -v a="$(mean "$room.$format.exr")" -v b="$(mean "$room.cycles.exr")" -v p="$expected" \
            'BEGIN { d = b > 0 ? 100 * (a / b - 1) : 999; printf "%+.1f %% ", d; print (d <= p && d >= -p ? "ok" : "FAILED: more than " p " %") }')
    elif grep -q "$expected" "$room.$format.log"; then
        verdict="told"
    else
        verdict="FAILED: '$expected' is not told"
        cat "$room.$format.log"
    fi
    echo "$room.$format: $verdict"
    [[ $verdict != *FAILED* ]] || failures=$((failures + 1))
}

for room in point sun emission metal instances color; do
    expect "$room" glb 2
done
# Where light falls steeply, or comes back often, it shows that Burley's surfaces are not Lambert's.
for room in spot texture; do
    expect "$room" glb 4
done
expect principled glb 10
for room in point spot sun area emission texture metal instances principled color; do
    expect "$room" fbx 12
done
expect shifted fbx 3
expect shifted glb "is read without a shift"
for room in point spot sun area texture instances color; do
    expect "$room" dae 18
done
# Light through glass and from mirrors falls as caustics, which paths do not find from point lamps. Collada has no glass.
caustics=(--integrator photonmap --photons 100000 --caustic-photons 100000 --spp 32)
expect glass glb 4 "${caustics[@]}"
expect glass glb 'the glass of material "glass" is a thin shell'
expect glass_volume glb 2 "${caustics[@]}"
expect glass_absorbing glb 2 "${caustics[@]}"
expect glass_absorbing glb "glass absorbs as Blender's Volume Absorption does"
expect metals glb 3 "${caustics[@]}"
expect metals fbx 12 "${caustics[@]}"
expect hdri glb 2 --sky sky.hdr
expect hdri fbx 12 --sky sky.hdr
expect hdri glb "Blender leaves area lamps and the world out of glTF files"
expect area glb "Blender leaves area lamps and the world out of glTF files"
expect world glb "Blender leaves area lamps and the world out of glTF files"
expect area fbx "its size and shape do not stand in the file"
expect emission dae "writes no strength of emission to Collada files"
expect world fbx "the file has no light"
expect world dae "the file has no light"
for room in point world; do
    expect "$room" obj "the file has no light"
done
((failures == 0))
