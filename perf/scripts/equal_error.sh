#!/usr/bin/env bash
# equal_error.sh: how far pictures are from the truth after equal CPU time: photon map, path tracing, and any command as a
# rival; whole pictures at defaults, by pairs of seeds (variance) and against a long path-traced picture (bias).
# Use: perf/scripts/equal_error.sh [options] SCENE...
# Writes equal_error.csv, .json, .md (the table) and .svg (the plot), and runs.csv, a row for each pair. Errors are those of perf/bench/pair_error.h.
set -euo pipefail
# shellcheck source=perf/scripts/suite.sh
. "$(dirname "${BASH_SOURCE[0]}")/suite.sh"

keep= # suite_begin begins with no runs
for ((i = 1; i <= $#; i++)); do
    if [[ ${!i} == --out ]]; then next=$((i + 1)) keep=${!next-}; fi
done
keep=${keep:-$suite_build/perf/equal_error}
kept=$(mktemp)
[[ ! -f $keep/runs.csv ]] || cp "$keep/runs.csv" "$kept"

suite_begin equal_error "usage: perf/scripts/equal_error.sh [options] [SCENE...]
Error at equal CPU time of whole pictures at defaults: photonmap, path, and rivals.
A SCENE is a file, or the name of one in \$AG_SCENES; without any, all that are there.
  --rival 'NAME=COMMAND'  a renderer to hold against: a shell command with {scene} {out} {seed}
                          {width} {height}, and either {seconds} of CPU that it is to take or {spp},
                          samples that are then chosen for it; it writes {out}; may be repeated
  --seconds LIST          CPU seconds of a picture (10,60,300); 0: the photon map at its defaults, all else with
                          64 samples
  --width N               of the pictures (640)
  --pairs N               of seeds (8); medians are told, with intervals
  --reference-spp N       samples of the reference (8192), kept in the build folder
  --threads N             of our own runs (one for each core)
  --resume                keep what is in runs.csv, and measure only what is not there" "$@"
seconds=10,60,300 width=640 pairs=8 reference_spp=8192 threads=0 resume=no arguments=() scenes=()
if [[ $quick == yes ]]; then seconds=0.4 width=32 pairs=2 reference_spp=256; fi
while ((${#suite_rest[@]} > 0)); do
    case ${suite_rest[0]} in
    --rival) arguments+=(--rival "${suite_rest[1]:?--rival wants NAME=COMMAND}") ;;
    --seconds) seconds=${suite_rest[1]:?--seconds wants a list} ;;
    --width) width=${suite_rest[1]:?--width wants a number} ;;
    --pairs) pairs=${suite_rest[1]:?--pairs wants a number} ;;
    --reference-spp) reference_spp=${suite_rest[1]:?--reference-spp wants a number} ;;
    --threads) threads=${suite_rest[1]:?--threads wants a number} ;;
    --resume) resume=yes suite_rest=("" "${suite_rest[@]}") ;; # as if it had a value
    -*) suite_no_more_options ;;
    *) scenes+=("${suite_rest[0]}") suite_rest=("" "${suite_rest[@]}") ;;
    esac
    suite_rest=("${suite_rest[@]:2}")
done
[[ $seconds =~ ^[0-9.]+(,[0-9.]+)*$ ]] || suite_fail "--seconds wants numbers with commas between, not '$seconds'"
for number in width pairs reference_spp; do
    [[ ${!number} =~ ^[1-9][0-9]*$ ]] || suite_fail "--${number//_/-} wants a number, not '${!number}'"
done
[[ $threads =~ ^[0-9]+$ ]] || suite_fail "--threads wants a number, not '$threads'"
if ((${#scenes[@]} == 0)); then
    scenes=("$suite_scenes"/*/scene.pbrt)
    [[ -f ${scenes[0]} ]] || suite_fail "no scene is given, and there are none in $suite_scenes"
fi
files=()
for scene in "${scenes[@]}"; do
    file=$scene
    [[ -f $file ]] || file=$suite_scenes/$scene/scene.pbrt
    [[ -f $file ]] || suite_fail "there is no scene '$scene'"
    files+=("$file")
done

[[ $resume == no || ! -s $kept ]] || cp "$kept" "$out/runs.csv"
rm -f "$kept"
status=0
python3 "$(dirname "${BASH_SOURCE[0]}")/equal_error.py" --program "$suite_program" --bin "$suite_bin" --work "$suite_work" \
    --out "$out" --references "$suite_build/perf/references" --seconds "$seconds" --width "$width" --pairs "$pairs" \
    --reference-spp "$reference_spp" --threads "$threads" ${arguments[@]+"${arguments[@]}"} -- "${files[@]}" || status=$?
((status == 0)) || exit "$status"
suite_json "$out/equal_error.csv"
cat "$out/equal_error.md"
