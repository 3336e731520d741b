#!/usr/bin/env bash
# Rooms made in Blender and exported by its exporters are as bright here as in Cycles: the means of the pictures, in each
# channel, are within 0.8 % for glTF where Cycles has Lambert's surfaces, too, 2 % where it has Burley's and 10 % where
# the material is not quite Blender's, 12 % for FBX and Collada. Collada's are held
# against surfaces with the specular and roughness of Blender's new materials, since Blender leaves out both. A warning names
# what a format leaves out. Skipped where Blender (with numpy, for its glTF exporter) is not installed.
# ctest: blender
set -euo pipefail
# shellcheck source=tests/fixtures/shell_test.sh
source "$(dirname "${BASH_SOURCE[0]}")/../fixtures/shell_test.sh"
need blender
cd "$folder"

if ! HOME=$folder timeout 1000 blender -b --factory-startup -P "$root/tests/fixtures/blender_rooms.py" -- "$folder" \
    >blender.log 2>&1 || [[ ! -s world.cycles.exr || ! -s world.obj ]]; then
    if grep -q "No module named 'numpy'\|has no attribute 'collada_export'\|could not be found" blender.log; then
        skip "this blender lacks an exporter: $(grep -m 1 Error blender.log)"
    fi
    tail -20 blender.log
    exit 1
fi

means() { # FILE: of each channel
    oiiotool --stats "$1" | awk '/Stats Avg/ { print $3, $4, $5; exit }'
}

deviation() { # FILE REFERENCE PERCENT: the largest of the three channels, and whether it is within
    awk -v a="$(means "$1")" -v b="$(means "$2")" -v p="$3" 'BEGIN {
        split(a, x); split(b, y); most = 0
        for (k = 1; k <= 3; k++) { d = y[k] > 0 ? 100 * (x[k] / y[k] - 1) : 999; if (d * d > most * most) most = d }
        printf "%+.1f %% ", most; print (most <= p && most >= -p ? "ok" : "FAILED: more than " p " %") }'
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
        verdict=$(deviation "$room.$format.exr" "$room.cycles.exr" "$expected")
    elif grep -q "$expected" "$room.$format.log"; then
        verdict="told"
    else
        verdict="FAILED: '$expected' is not told"
        cat "$room.$format.log"
    fi
    echo "$room.$format: $verdict"
    [[ $verdict != *FAILED* ]] || failures=$((failures + 1))
}

for room in point spot sun emission texture texture_between metal instances color; do
    expect "$room" glb 2
done
# The rest is that Burley's surfaces are not Lambert's.
for room in point spot sun emission texture texture_between instances color; do
    verdict=$(deviation "$room.glb.exr" "$room.lambert.cycles.exr" 0.8)
    echo "$room.glb, Lambert's surfaces: $verdict"
    [[ $verdict != *FAILED* ]] || failures=$((failures + 1))
done
expect principled glb 10
for room in point spot sun area area_glossy emission texture metal instances principled color; do
    expect "$room" fbx 12
done
expect shifted fbx 3
expect shifted glb "is read without a shift"
for room in area_glossy principled; do
    expect "$room" dae 12
done
for room in point spot sun area texture metal instances color; do
    expect "$room" dae "Blender writes neither roughness nor specular to Collada files"
    verdict=$(deviation "$room.dae.exr" "$room.default.cycles.exr" 12)
    echo "$room.dae, with Blender's default for what is not in the file: $verdict"
    [[ $verdict != *FAILED* ]] || failures=$((failures + 1))
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
