#!/usr/bin/env bash
# error_against_time.sh: how far from the truth after how much CPU time: photon map and path tracing on the same scenes,
# held against a long path-traced reference of another seed (kept in the build folder); all light, and indirect alone.
# Use: perf/scripts/error_against_time.sh [--quick] [--repeats N] [--out DIR] [--reference-spp N] [--scenes LIST] [--resume]
# Writes error.csv and .json (the curves), equal_error.csv (when the photon map has the error that path tracing has
# after so many samples; 64 are judged), runs.csv and the figures. Pictures have half the scenes' own width (the
# room: as many pixels as cornell-box): edges, which only camera samples settle, have about the share of the error that
# they have in pictures people make.
set -euo pipefail
# shellcheck source=perf/scripts/suite.sh
. "$(dirname "${BASH_SOURCE[0]}")/suite.sh"

suite_begin error_against_time "usage: perf/scripts/error_against_time.sh [options]
Relative mean square error against CPU time, photonmap and path.
  --reference-spp N  samples of the reference (4096), kept by scene and N
  --resume           keep what is in errors.csv, and measure only what is not there
  --scenes LIST      of cornell-box, veach-ajar (in \$AG_SCENES), room (all three, as far as they are there)" "$@"
reference_spp=4096 resume=no scenes=cornell-box,veach-ajar,room
if [[ $quick == yes ]]; then reference_spp=64 scenes=room; fi
while ((${#suite_rest[@]} > 0)); do
    case ${suite_rest[0]} in
    --reference-spp) reference_spp=${suite_rest[1]:?--reference-spp wants a number} ;;
    --scenes) scenes=${suite_rest[1]:?--scenes wants a list} ;;
    --resume) resume=yes suite_rest=("" "${suite_rest[@]}") ;; # as if it had a value
    *) suite_no_more_options ;;
    esac
    suite_rest=("${suite_rest[@]:2}")
done

# photons-caustic photons-samples a pixel-gather rays a sample, and where they differ from 1 and the scene's own: -fraction
# that are irradiance photons-photons of an estimate; and samples a pixel of path tracing
photon_map_steps=(3000-100-4-1 10000-300-4-1 30000-1000-4-4 30000-1000-16-1 100000-3000-16-4 300000-10000-16-8
    30000-300-1-4-1-50 30000-300-1-8-0.25-50 20000-300-4-4-0.0625-30 40000-1000-4-6-0.0625-50 60000-1000-4-8-0.0625-60
    60000-1000-4-12-0.0625-60 100000-1000-8-8-0.0625-60 100000-3000-16-4-0.125-60 200000-3000-16-8-0.125-60
    200000-3000-64-4-0.125-60)
path_steps=(1 4 16 64 256) parts=(all indirect)
if [[ $quick == yes ]]; then photon_map_steps=(1000-100-4-1) path_steps=(64) parts=(indirect); fi

scene_options() { # NAME: sets scene and options; false where it is not there
    case $1 in
    cornell-box) scene=$suite_scenes/cornell-box/scene.pbrt options=(--size 160x160) ;;
    veach-ajar) scene=$suite_scenes/veach-ajar/scene.pbrt options=(--size 160x90) ;;
    room)
        suite_room 20
        scene=$room options=(--size 160x160 --nearest 50 --radius 0)
        [[ $quick == yes ]] && options=(--size 20x20 --nearest 50 --radius 0)
        ;;
    *) suite_fail "--scenes does not know '$1'" ;;
    esac
    [[ -f $scene ]]
}

make_reference() { # NAME PART OPTIONS...: sets reference
    local name=$1 part=$2
    shift 2
    reference=$suite_build/perf/references/$name-$part-$(printf '%s' "$*" | tr -c 'a-z0-9' _)-$reference_spp.exr
    mkdir -p "${reference%/*}"
    if [[ ! -s $reference ]]; then
        echo "error_against_time: reference of $name, $part: $reference_spp samples a pixel" >&2
        "$suite_program" -q --progress none "$scene" "$@" --integrator path --spp "$reference_spp" --seed 1000003 \
            -o "$reference.part.exr" && mv "$reference.part.exr" "$reference"
    fi
}

heading=scene,part,integrator,step,repeat,size,work_cpu_s,cpu_s,error,mean_ratio
if [[ $resume == no || ! -s $out/errors.csv || $(head -n 1 "$out/errors.csv") != "$heading" ]]; then
    echo "$heading" >"$out/errors.csv"
fi
one_run() { # NAME PART INTEGRATOR STEP REPEAT OPTIONS...: the work is all but loading and writing
    local name=$1 part=$2 integrator=$3 step=$4 repeat=$5 times error
    shift 5
    if grep -q "^$name,$part,$integrator,$step,$repeat," "$out/errors.csv"; then return; fi
    suite_run "$name-$part" "$integrator-$step" "$repeat" "$scene" "$@" --integrator "$integrator" --seed "$repeat"
    times=$(jq -r '[.phase_cpu_s.photons + .phase_cpu_s.map + .phase_cpu_s.precompute + .phase_cpu_s.render, .cpu_s] |
        map(tostring) | join(",")' "$suite_work/run.json")
    error=$("$suite_bin/afterglow-picture-error" "$suite_work/run.exr" "$reference")
    echo "$name,$part,$integrator,$step,$repeat,${options[1]},$times,${error#*,}" >>"$out/errors.csv"
}

for ((r = 1; r <= repeats; r++)); do
    for name in ${scenes//,/ }; do
        if ! scene_options "$name"; then
            echo "error_against_time: left out: $name: $scene is not there" >&2
            continue
        fi
        # what an earlier version measured at another size is not gone on with
        ((r > 1)) || sed -i "/^$name,/{/^\([^,]*,\)\{5\}${options[1]},/!d}" "$out/errors.csv"
        for part in "${parts[@]}"; do
            part_options=("${options[@]}")
            [[ $part == indirect ]] && part_options+=(--only indirect)
            make_reference "$name" "$part" "${part_options[@]}"
            for step in "${path_steps[@]}"; do
                one_run "$name" "$part" path "$step" "$r" "${part_options[@]}" --spp "$step"
            done
            for step in "${photon_map_steps[@]}"; do
                IFS=- read -r photons caustic spp gather fraction nearest <<<"$step"
                one_run "$name" "$part" photonmap "$step" "$r" "${part_options[@]}" --photons "$photons" \
                    --caustic-photons "$caustic" --spp "$spp" --gather-samples "$gather" \
                    --irradiance-fraction "${fraction:-1}" ${nearest:+--nearest "$nearest"}
            done
        done
    done
done

# reference_share: what the reference's own noise, which is path tracing's, has of the error: a bound on what is seen.
awk -v reference_spp="$reference_spp" "$suite_awk"'
{
    key = $1 "," $2 "," $3 "," $4
    if (!(key in n)) order[++keys] = key
    r = ++n[key]; work[key, r] = $7; cpu[key, r] = $8; error[key] += $9; mean[key] += $10
    if ($3 == "path" && $4 == 64) { path[$1 "," $2] += $9; paths[$1 "," $2]++ }
}
END {
    print "scene,part,integrator,step,work_cpu_s,cpu_s,error,mean_ratio,reference_share"
    for (k = 1; k <= keys; k++) {
        key = order[k]; split(key, word, ",")
        for (r = 1; r <= n[key]; r++) { a[r] = work[key, r]; b[r] = cpu[key, r] }
        noise = path[word[1] "," word[2]] / paths[word[1] "," word[2]] * 64 / reference_spp
        printf "%s,%.5f,%.4f,%.6g,%.5f,%.3f\n", key, median(a, n[key]), median(b, n[key]), error[key] / n[key],
            mean[key] / n[key], noise / (error[key] / n[key])
    }
}' "$out/errors.csv" >"$out/error.csv"
suite_json "$out/error.csv"

# When the photon map has path tracing's error after 64 samples: between two steps by logarithms, on its best steps alone.
# A step whose picture is brighter or darker as a whole by more than a twentieth is not looked at, whatever its error:
# nobody would take it for the same picture, and path tracing's error of 64 samples is large where its paths are rare.
awk "$suite_awk"'
{
    scene = $at["scene"] "," $at["part"]
    if ($at["integrator"] == "path") {
        order[++keys] = scene "," $at["step"]; of[keys] = scene
        target[keys] = $at["error"]; path[keys] = $at["work_cpu_s"]
    } else if ($at["mean_ratio"] > 0.95 && $at["mean_ratio"] < 1.05) {
        i = ++n[scene]; t[scene, i] = $at["work_cpu_s"]; e[scene, i] = $at["error"]
    }
}
END {
    print "scene,part,path_samples,path_error,path_cpu_s,photonmap_cpu_s,faster,note"
    for (k = 1; k <= keys; k++) {
        key = of[k]; best = ""; note = "never within these steps"; m = n[key]
        for (i = 1; i <= m; i++) if (e[key, i] <= target[k] && (best == "" || t[key, i] < best)) {
            best = t[key, i]; note = "or earlier: the cheapest step is better already"; where = i
        }
        if (best != "") for (j = 1; j <= m; j++) # a cheaper step of a larger error: between the two
            if (t[key, j] < t[key, where] && e[key, j] > target[k]) {
                share = log(e[key, j] / target[k]) / log(e[key, j] / e[key, where])
                between = exp(log(t[key, j]) + share * log(t[key, where] / t[key, j]))
                if (between < best) { best = between; note = "between two steps" }
            }
        printf "%s,%.6g,%.5f,%s,%s,%s\n", order[k], target[k], path[k], best == "" ? "" : sprintf("%.5f", best),
            best == "" ? 0 : sprintf("%.3f", path[k] / best), note
    }
}' "$out/error.csv" >"$out/equal_error.csv"
suite_json "$out/equal_error.csv"

for name in ${scenes//,/ }; do
    grep -q "^$name," "$out/error.csv" || continue
    suite_plot "$out/error-$name" <<PLOT
set logscale xy; set xlabel "CPU seconds of the work (photons, map, picture)"; set ylabel "relative mean square error"
set title "$name: error against time"; set key top right
of(part, integrator) = sprintf("< grep '^$name,%s,%s,' '$out/error.csv' | cut -d, -f5,7 | sort -t, -g", part, integrator)
plot of("all", "path") using 1:2 with linespoints lw 2 lc rgb "#1f77b4" title "path tracing", \
    of("all", "photonmap") using 1:2 with linespoints lw 2 lc rgb "#d62728" title "photon map", \
    of("indirect", "path") using 1:2 with linespoints lw 2 dt 2 lc rgb "#1f77b4" title "path tracing, indirect light", \
    of("indirect", "photonmap") using 1:2 with linespoints lw 2 dt 2 lc rgb "#d62728" title "photon map, indirect light"
PLOT
done
while IFS=, read -r name part samples _ _ _ faster _; do
    [[ $samples != 64 ]] || suite_ratio "error.$name.$part" "$faster"
done < <(tail -n +2 "$out/equal_error.csv")
column -t -s, "$out/equal_error.csv"
