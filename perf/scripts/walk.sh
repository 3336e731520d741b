#!/usr/bin/env bash
# walk.sh: whether a walk through a room flickers: frames of one kept photon map, and of a new map for each, beside path
# tracing; what changes from frame to frame, the camera's motion taken out, over what the pictures' own noise explains.
# Use: perf/scripts/walk.sh [options] [SCENE...]
# Writes walk.csv and .json. How frames are compared is told in walk.py.
set -euo pipefail
# shellcheck source=perf/scripts/suite.sh
. "$(dirname "${BASH_SOURCE[0]}")/suite.sh"

suite_begin walk "usage: perf/scripts/walk.sh [options] [SCENE...]
Flicker in a walk to the side: squared change of indirect light between frames over what the noise of both explains,
by pixels and by blocks of 8 x 8 of them, with a kept photon map, with a new one for each frame, and path traced.
A SCENE is a file, or the name of one in \$AG_SCENES; without any, classroom, living-room-2 and dining-room.
  --frames N       of each walk (48)
  --width N        of the pictures (160), which are 9 / 16 as high
  --spp N          samples (8)
  --step X         of the eye from frame to frame, as a share of the distance to what it looks at (0.004)
  --kinds LIST     of kept, new, path (kept,new,path)" "$@"
frames=48 width=160 spp=8 step=0.004 kinds=kept,new,path scenes=()
photons=(--photons 1000000 --caustic-photons 500000) # kept maps and new ones alike
if [[ $quick == yes ]]; then frames=3 width=64 spp=4 photons=(--photons 100000 --caustic-photons 50000); fi
while ((${#suite_rest[@]} > 0)); do
    case ${suite_rest[0]} in
    --frames | --width | --spp | --step | --kinds) declare "${suite_rest[0]#--}=${suite_rest[1]:?${suite_rest[0]} wants a value}" ;;
    -*) suite_no_more_options ;;
    *) scenes+=("${suite_rest[0]}") suite_rest=("" "${suite_rest[@]}") ;;
    esac
    suite_rest=("${suite_rest[@]:2}")
done
for number in frames width spp; do
    [[ ${!number} =~ ^[1-9][0-9]*$ ]] || suite_fail "--$number wants a number, not '${!number}'"
done
((frames >= 2)) || suite_fail "--frames wants 2 or more"
[[ $step =~ ^[0-9]*\.?[0-9]+$ ]] || suite_fail "--step wants a number, not '$step'"
[[ $kinds =~ ^(kept|new|path)(,(kept|new|path))*$ ]] || suite_fail "--kinds wants some of kept, new, path, not '$kinds'"
((${#scenes[@]} > 0)) || scenes=(classroom living-room-2 dining-room)

walk() { # SCENE_FILE NAME KIND
    local file=$1 name=$2 kind=$3 number=0 eye_x eye_y eye_z x y z ratios options=("${photons[@]}")
    [[ $kind != path ]] || options+=(--integrator path)
    [[ $kind != kept ]] || options+=(--photon-seed 1 --photon-map "$suite_work/$name.map")
    while read -r eye_x eye_y eye_z x y z; do
        number=$((number + 1))
        suite_run "$name" "$kind" "$number" --seed "$number" --size "${width}x$((width * 9 / 16))" --spp "$spp" --type float \
            --only indirect --aov P --aov variance --camera-from "$eye_x,$eye_y,$eye_z" --camera-to "$x,$y,$z" \
            ${options[@]+"${options[@]}"} "$file"
        mv "$suite_work/run.exr" "$suite_work/$(printf frame-%04d.exr "$number")"
    done <"$suite_work/cameras"
    ratios=$(python3 "$suite_walk" flicker "$suite_work"/frame-*.exr)
    echo "$name,$kind,$frames,$ratios" >>"$out/walk.csv"
    rm -f "$suite_work"/frame-*.exr "$suite_work/$name.map"
}

suite_walk=$(dirname "${BASH_SOURCE[0]}")/walk.py
echo "scene,kind,frames,pixels,pixel_ratio,block_ratio" >"$out/walk.csv"
for scene in "${scenes[@]}"; do
    file=$scene
    [[ -f $file ]] || file=$suite_scenes/$scene/scene.pbrt
    [[ -f $file ]] || suite_fail "there is no scene '$scene'"
    name=$(basename "$(dirname "$file")")
    [[ $(basename "$file") == scene.pbrt ]] || name=$(basename "$file" .pbrt)
    "$suite_program" -q --noise 0 --spp 4 --size "${width}x$((width * 9 / 16))" --integrator path --type float --aov P \
        --aov variance -o "$suite_work/first.exr" "$file"
    python3 "$suite_walk" camera "$suite_work/first.exr" "$step" "$frames" >"$suite_work/cameras"
    for kind in ${kinds//,/ }; do walk "$file" "$name" "$kind"; done
done
suite_json "$out/walk.csv"
cat "$out/walk.csv"
