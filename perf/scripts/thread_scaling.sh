#!/usr/bin/env bash
# thread_scaling.sh: how each phase gets faster with threads, held against what the machine itself gives those threads:
# a loop of pure arithmetic, run in turn with the renderer.
# Use: perf/scripts/thread_scaling.sh [--quick] [--repeats N] [--out DIR] [--threads LIST] [SCENE [options of afterglow]]
# Writes scaling.csv and .json (speed-up by phase), waiting.csv, arithmetic.csv, runs.csv and the figure.
# Exit code 1 when a picture differs in any bit from the one of one thread.
set -euo pipefail
# shellcheck source=perf/scripts/suite.sh
. "$(dirname "${BASH_SOURCE[0]}")/suite.sh"

suite_begin thread_scaling "usage: perf/scripts/thread_scaling.sh [options] [SCENE [options of afterglow]]
Speed-up and efficiency by phase, with 1 thread, 2, 4, ... all cores, and twice as many.
  SCENE        any scene (room 20 of the forty, 16 gather rays, indirect light only)
  --threads L  other numbers of threads, by commas; the first is what the others are held against" "$@"
threads=''
if [[ ${suite_rest[0]:-} == --threads ]]; then
    threads=${suite_rest[1]:?--threads wants a list}
    suite_rest=("${suite_rest[@]:2}")
fi
if [[ -z $threads && $quick == yes ]]; then
    threads=1,$((suite_cores > 1 ? suite_cores : 2))
elif [[ -z $threads ]]; then
    threads=1
    for ((n = 2; n < suite_cores; n *= 2)); do threads+=,$n; done
    ((suite_cores > 1)) && threads+=,$suite_cores
    threads+=,$((2 * suite_cores))
fi
[[ $threads =~ ^[0-9]+(,[0-9]+)*$ ]] || suite_fail "--threads wants numbers by commas, not '$threads'"
if ((${#suite_rest[@]} == 0)); then
    suite_room 20
    suite_rest=("$room" --only indirect --gather-samples 16)
    [[ $quick == yes ]] && suite_rest=("$room" --only indirect --gather-samples 4 --size 48x48 --photons 20000)
fi

units=64
[[ $quick == yes ]] && units=1
echo "threads,repeat,wall_s,cpu_s" >"$out/arithmetic.csv"
echo "cache,threads,repeat,differing" >"$out/pixels.csv"
first=${threads%%,*}
for ((r = 1; r <= repeats; r++)); do
    for n in ${threads//,/ }; do
        limit=$("$suite_bin/afterglow-arithmetic" "$n" "$units")
        echo "$n,$r,$limit" >>"$out/arithmetic.csv"
        for cache in on-demand precompute; do
            suite_run scaling "$cache" "$r" --cache "$cache" -t "$n" "${suite_rest[@]}"
            kept=$suite_work/scaling.exr
            if ((r == 1)) && [[ $n == "$first" && $cache == on-demand ]]; then cp "$suite_work/run.exr" "$kept"; fi
            error=$("$suite_bin/afterglow-picture-error" "$suite_work/run.exr" "$kept")
            echo "$cache,$n,$r,${error%%,*}" >>"$out/pixels.csv"
        done
    done
done

# Ratios are taken within a repeat, and their medians told: both halves have seen the same noise. work: all that grows
# with the picture, from the first photon to the last pixel. other: what is in no phase, once a process: finding and
# linking the image library, mostly. either: photons and their tree do not depend on the way of caching, and short as
# they are, both ways' runs are looked at.
awk -v first="$first" -v list="$threads" -v repeats="$repeats" "$suite_awk"'
FILENAME ~ /\/arithmetic\.csv$/ { arithmetic[$1, $2] = $3; next }
function keep(cache, phase, run, wall_s, cpu_s) {
    t[cache, phase, $at["threads"], run] = wall_s
    c[cache, phase, $at["threads"], run] = cpu_s
}
{
    variant = $at["variant"]; r = $at["repeat"]; work = work_cpu = told = told_cpu = 0
    for (p = 1; p <= phases; p++) {
        wall_s = $at[name[p] "_s"]
        cpu_s = name[p] "_cpu_s" in at ? $at[name[p] "_cpu_s"] : name[p] == "total" ? $at["cpu_s"] : ""
        keep(variant, name[p], r, wall_s, cpu_s)
        if (name[p] !~ /^(startup|total)$/) { told += wall_s; told_cpu += cpu_s }
        if (name[p] ~ /^(photons|map|precompute|render)$/) { work += wall_s; work_cpu += cpu_s }
        if (name[p] ~ /^(photons|map)$/) keep("either", name[p], 2 * r - (variant == "on-demand"), wall_s, cpu_s)
    }
    keep(variant, "other", r, $at["total_s"] - told, $at["cpu_s"] - told_cpu)
    keep(variant, "work", r, work, work_cpu)
}
function show(x) { return x == "" ? "" : sprintf("%.4g", x) }
function tell(cache, phase, runs,    i, r, m, mg, limit_of) {
    for (i = 1; i <= count; i++) {
        m = mg = 0
        for (r = 1; r <= runs; r++) {
            limit_of = cache == "either" ? int((r + 1) / 2) : r
            wall[r] = t[cache, phase, n[i], r]; cpu[r] = c[cache, phase, n[i], r]
            limit[r] = arithmetic[first, limit_of] / arithmetic[n[i], limit_of]
            if (wall[r] > 1e-6) {
                s[++m] = t[cache, phase, first, r] / wall[r]
                e[m] = s[m] / limit[r]
            }
            if (c[cache, phase, first, r] > 0) g[++mg] = cpu[r] / c[cache, phase, first, r]
        }
        printf "%s,%s,%d,%.6f,%s,%s,%.4g,%s,%s\n", cache, phase, n[i], median(wall, runs),
            show(cpu[1] == "" ? "" : median(cpu, runs)), show(median(s, m)), median(limit, runs), show(median(e, m)), show(median(g, mg))
    }
}
BEGIN { phases = split("startup,load,bvh,photons,map,precompute,render,write,total", name, ",") }
END {
    print "cache,phase,threads,wall_s,cpu_s,speedup,limit,efficiency,cpu_growth"
    count = split(list, n, ",")
    name[phases + 1] = "other"; name[phases + 2] = "work"
    split("on-demand,precompute", caches, ",")
    for (k = 1; k <= 2; k++) for (p = 1; p <= phases + 2; p++) tell(caches[k], name[p], repeats)
    tell("either", "photons", 2 * repeats)
    tell("either", "map", 2 * repeats)
}' "$out/arithmetic.csv" "$suite_runs" >"$out/scaling.csv"
suite_json "$out/scaling.csv"

# busy: the share of the threads that fit on the cores which was computing, over the whole run.
awk -v cores="$suite_cores" "$suite_awk"'
FNR == 2 { print "cache,threads,repeat,requests,computed,deferred,waited,wait_s,cpu_s,wall_s,waiting_share,busy" }
{
    n = $at["threads"] < cores ? $at["threads"] : cores
    printf "%s,%d,%d,%d,%d,%d,%d,%.6f,%.4f,%.4f,%.3g,%.3f\n", $at["variant"], $at["threads"], $at["repeat"],
        $at["requests"], $at["computed"], $at["deferred"], $at["waited"], $at["wait_s"], $at["cpu_s"], $at["total_s"],
        $at["wait_s"] / $at["cpu_s"], $at["cpu_s"] / ($at["total_s"] * n)
}' "$suite_runs" >"$out/waiting.csv"
suite_json "$out/waiting.csv"

suite_plot "$out/scaling" <<PLOT
set multiplot layout 1,2 title "Room 20, or the scene asked for: speed-up by phase"
set logscale x 2; set xlabel "threads"; set key top left
set ylabel "speed-up"; set logscale y 2
csv = "$out/scaling.csv"
of(cache, phase, column) = sprintf("< grep '^%s,%s,' '%s' | cut -d, -f3,%d", cache, phase, csv, column)
plot of("either", "photons", 6) using 1:2 with linespoints lw 2 title "photons", \
    of("either", "map", 6) using 1:2 with linespoints lw 2 title "map", \
    of("precompute", "precompute", 6) using 1:2 with linespoints lw 2 title "precompute", \
    of("on-demand", "render", 6) using 1:2 with linespoints lw 2 title "render, on demand", \
    of("precompute", "render", 6) using 1:2 with linespoints lw 2 title "render, precomputed", \
    of("on-demand", "work", 6) using 1:2 with linespoints lw 2 title "all of these, on demand", \
    of("on-demand", "total", 6) using 1:2 with linespoints lw 2 title "and loading, writing, on demand", \
    of("on-demand", "total", 7) using 1:2 with lines lc rgb "black" dt 2 lw 2 title "the machine's limit"
set ylabel "share of the machine's limit"; unset logscale y; set yrange [0:1.2]; unset key
plot of("either", "photons", 8) using 1:2 with linespoints lw 2, \
    of("either", "map", 8) using 1:2 with linespoints lw 2, \
    of("precompute", "precompute", 8) using 1:2 with linespoints lw 2, \
    of("on-demand", "render", 8) using 1:2 with linespoints lw 2, \
    of("precompute", "render", 8) using 1:2 with linespoints lw 2, \
    of("on-demand", "work", 8) using 1:2 with linespoints lw 2, \
    of("on-demand", "total", 8) using 1:2 with linespoints lw 2, \
    1 with lines lc rgb "black" dt 2 lw 2
unset multiplot
PLOT

# The ratios that run.sh judges, with as many threads as there are cores, and the share of a core that one thread of
# arithmetic got.
suite_ratio scaling.machine_share "$(awk -v first="$first" "$suite_awk"'
    $1 == first { v[++n] = $4 / ($3 * $1) } END { print median(v, n) }' "$out/arithmetic.csv")"
for pair in either:photons either:map precompute:precompute on-demand:render on-demand:work; do
    value=$(awk -F, -v cache="${pair%:*}" -v phase="${pair#*:}" -v n="$suite_cores" \
        '$1 == cache && $2 == phase && $3 == n { print $8 }' "$out/scaling.csv")
    [[ -z $value ]] || suite_ratio "scaling.${pair#*:}" "$value"
done
differing=$(awk -F, 'NR > 1 { sum += $4 } END { print sum + 0 }' "$out/pixels.csv")
suite_ratio scaling.pixels_differing "$differing"
suite_ratio scaling.computed_differing "$(awk "$suite_awk"'
    { v = $at["variant"]; x = $at["computed"]; if (!(v in seen)) seen[v] = x; differing += seen[v] != x }
    END { print differing + 0 }' "$suite_runs")"
suite_ratio scaling.duplicated "$(awk "$suite_awk"'{ sum += $at["duplicated"] } END { print sum + 0 }' "$suite_runs")"
column -t -s, "$out/scaling.csv"
if ((differing > 0)); then suite_fail "$differing pixels differ between numbers of threads: $out/pixels.csv"; fi
