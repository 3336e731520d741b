#!/usr/bin/env bash
# moving.sh: frames in which little moves: a ball of 5 cm behind the camera of a room of 4 m, which goes on by 5 cm from
# frame to frame, with fixed photon paths; the picture is of the wall opposite.
# Use: perf/scripts/moving.sh [--quick] [--repeats N] [--out DIR]
# Writes moving.csv and .json: by the nearest photons k of an estimate, c, the share of the photons that came or went;
# anew, the share of the irradiances of a frame rendered alone that one which follows another computes; bound, 1 - (1 -
# c)^k; change, how far the wall changes from frame to frame as relative root mean square, in per cent; change_stored,
# how far with a fixed number of photons; cpu_s of frames that follow and of frames alone, the first left out. Fails
# where a frame that follows has other bits than the frame alone.
set -euo pipefail
# shellcheck source=perf/scripts/suite.sh
. "$(dirname "${BASH_SOURCE[0]}")/suite.sh"

suite_begin moving "usage: perf/scripts/moving.sh [options]
What is computed anew, and what changes, where a small ball moves behind the camera." "$@"
suite_no_more_options
frames=6 paths=55000 size=160 samples=16
[[ $quick == yes ]] && frames=3 paths=6000 size=24 samples=1
cat >"$suite_work/room.pbrt" <<'END'
LookAt 0 0 -1.5  0 0 2  0 1 0
Camera "perspective" "float fov" 55
WorldBegin
AttributeBegin
Translate 0 1.99 0
AreaLightSource "diffuse" "rgb L" [10 10 10]
Shape "trianglemesh" "point3 P" [-.5 0 -.5 .5 0 -.5 .5 0 .5 -.5 0 .5] "integer indices" [0 1 2 0 2 3]
AttributeEnd
Material "diffuse" "rgb reflectance" [.7 .7 .7]
Shape "trianglemesh" "point3 P" [-2 -2 -2 2 -2 -2 2 -2 2 -2 -2 2] "integer indices" [0 2 1 0 3 2]
Shape "trianglemesh" "point3 P" [-2 2 -2 2 2 -2 2 2 2 -2 2 2] "integer indices" [0 1 2 0 2 3]
Shape "trianglemesh" "point3 P" [-2 -2 2 2 -2 2 2 2 2 -2 2 2] "integer indices" [0 2 1 0 3 2]
Shape "trianglemesh" "point3 P" [-2 -2 -2 2 -2 -2 2 2 -2 -2 2 -2] "integer indices" [0 1 2 0 2 3]
Material "diffuse" "rgb reflectance" [.7 .2 .2]
Shape "trianglemesh" "point3 P" [-2 -2 -2 -2 2 -2 -2 2 2 -2 -2 2] "integer indices" [0 1 2 0 2 3]
Material "diffuse" "rgb reflectance" [.2 .7 .2]
Shape "trianglemesh" "point3 P" [2 -2 -2 2 2 -2 2 2 2 2 -2 2] "integer indices" [0 2 1 0 3 2]
Material "diffuse" "rgb reflectance" [.5 .5 .5]
AttributeBegin
Translate $x -1 -1.8
Shape "sphere" "float radius" .05
AttributeEnd
END

common=(-q --size "${size}x$size" --spp "$samples" --noise 0 --only indirect --type float --reproducible
    --progress none --photon-aim 0 -D 'x=0.%02d')
last=$((5 * frames))

# The root of the mean, over all neighbouring frames NAME.N.exr, of their relative mean square difference, per cent.
change() {
    local n
    for ((n = 10; n <= last; n += 5)); do
        "$suite_bin/afterglow-picture-error" "$suite_work/$1.$n.exr" "$suite_work/$1.$((n - 5)).exr"
    done | awk -F, '{ sum += $2 } END { printf "%.4f", 100 * sqrt(sum / NR) }'
}

echo "nearest,guiding,photons,c,anew,bound,anew_over_bound,change,change_stored,cpu_s,cpu_alone_s" >"$out/moving.csv"
for variant in "50 0" "100 0" "300 0" "50 0.5"; do
    read -r nearest guiding <<<"$variant"
    arguments=("${common[@]}" --nearest "$nearest" --gather-guiding "$guiding")
    "$suite_program" "${arguments[@]}" --photon-paths "$paths" --frames "5-${last}x5" -o "$suite_work/follows.%d.exr" \
        --stats "$suite_work/follows.%d.json" "$suite_work/room.pbrt"
    for ((n = 5; n <= last; n += 5)); do
        "$suite_program" "${arguments[@]}" --photon-paths "$paths" --frames "$n" -o "$suite_work/alone.%d.exr" \
            --stats "$suite_work/alone.%d.json" "$suite_work/room.pbrt"
        cmp "$suite_work/follows.$n.exr" "$suite_work/alone.$n.exr" || suite_fail "frame $n: other bits than alone"
    done
    stored=$(jq .photons.stored_global "$suite_work/alone.5.json")
    "$suite_program" "${arguments[@]}" --photons "$stored" --frames "5-${last}x5" -o "$suite_work/stored.%d.exr" \
        "$suite_work/room.pbrt"
    for ((n = 10; n <= last; n += 5)); do
        jq -r -s '.[0].photons.stored_global as $all | [$all, (.[0].photons.came + .[0].photons.went) / $all,
            .[0].irradiance.computed / .[1].irradiance.computed,
            (.[0].phase_cpu_s | add), (.[1].phase_cpu_s | add)] | map(tostring) | join(",")' \
            "$suite_work/follows.$n.json" "$suite_work/alone.$n.json"
    done | awk -F, -v k="$nearest" -v guiding="$guiding" -v change="$(change follows)" -v stored="$(change stored)" '
        { photons += $1; c += $2; anew += $3; bound += 1 - (1 - $2) ^ k; cpu += $4; alone += $5 }
        END { printf "%d,%s,%d,%.5f,%.4f,%.4f,%.3f,%s,%s,%.2f,%.2f\n", k, guiding, photons / NR, c / NR, anew / NR,
            bound / NR, anew / bound, change, stored, cpu / NR, alone / NR }' >>"$out/moving.csv"
done
suite_json "$out/moving.csv"
column -t -s, "$out/moving.csv"
