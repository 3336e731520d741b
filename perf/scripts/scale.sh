#!/usr/bin/env bash
# scale.sh: how the time of a phase grows with what it works on: photons, pixels, gather rays, spheres, triangles,
# instances, materials, lamps, over two to three decades each; the exponent e of time ~ size^e, by least squares over all sizes, and over the last decade alone.
# Use: perf/scripts/scale.sh [--quick] [--repeats N] [--out DIR]
# CPU time of one thread, which a busy machine disturbs least. Writes scale.csv, exponents.csv (and .json), runs.csv and
# the figure.
set -euo pipefail
# shellcheck source=perf/scripts/suite.sh
. "$(dirname "${BASH_SOURCE[0]}")/suite.sh"

suite_begin scale "usage: perf/scripts/scale.sh [options]
Exponents: CPU time against photons, pixels, gather rays, spheres, triangles, instances, materials and lamps." "$@"
suite_no_more_options
photons=(1000 10000 100000 1000000) sides=(32 100 316 1000) gathers=(1 10 100 1000)
spheres=(100 1000 10000 100000) triangles=(1000 10000 100000 1000000)
instances=(1000 10000 100000 1000000) materials=(100 1000 10000) lamps=(10 100 1000)
if [[ $quick == yes ]]; then
    photons=(1000 10000) sides=(16 50) gathers=(1 10) spheres=(100 1000) triangles=(1000 10000)
    instances=(100 1000) materials=(100 1000) lamps=(10 100)
fi
suite_room 20
for kind in spheres triangles instances materials lamps; do
    declare -n sizes=$kind
    for n in "${sizes[@]}"; do
        mkdir -p "$suite_work/scale-$n"
        "$suite_bin/afterglow-large-scene" "$kind" "$n" "$suite_work/scale-$n"
    done
done

common=(-t 1 --only indirect --spp 1)
for ((r = 1; r <= repeats; r++)); do
    for n in "${photons[@]}"; do
        suite_run photons "$n" "$r" "$room" "${common[@]}" --size 8x8 --gather-samples 1 --photons "$n"
    done
    for n in "${sides[@]}"; do
        suite_run pixels $((n * n)) "$r" "$room" "${common[@]}" --size "${n}x$n" --gather-samples 4 --photons 10000 \
            --cache precompute
    done
    for n in "${gathers[@]}"; do
        suite_run gather "$n" "$r" "$room" "${common[@]}" --size 40x40 --gather-samples "$n" --photons 10000 \
            --cache precompute
    done
    for kind in spheres triangles instances materials; do
        declare -n sizes=$kind
        for n in "${sizes[@]}"; do
            suite_run "$kind" "$n" "$r" "$suite_work/scale-$n/$kind.pbrt" "${common[@]}" --gather-samples 4 \
                --photons 10000 --cache precompute
        done
    done
    for n in "${lamps[@]}"; do # all light, of which most is direct
        suite_run lamps "$n" "$r" "$suite_work/scale-$n/lamps.pbrt" -t 1 --spp 4 --noise 0 --gather-samples 4 \
            --photons 10000 --cache precompute
    done
done

awk "$suite_awk"'
{
    key = $at["bench"] "," $at["variant"]
    if (!(key in n)) order[++keys] = key
    r = ++n[key]
    load[key, r] = $at["load_cpu_s"] + $at["bvh_cpu_s"]; photons[key, r] = $at["photons_cpu_s"]
    map[key, r] = $at["map_cpu_s"]; render[key, r] = $at["render_cpu_s"]
}
END {
    print "bench,size,load_s,photons_s,map_s,render_s"
    for (k = 1; k <= keys; k++) {
        key = order[k]
        for (r = 1; r <= n[key]; r++) {
            a[r] = load[key, r]; b[r] = photons[key, r]; c[r] = map[key, r]; d[r] = render[key, r]
        }
        printf "%s,%.6f,%.6f,%.6f,%.6f\n", key, median(a, n[key]), median(b, n[key]), median(c, n[key]), median(d, n[key])
    }
}' "$suite_runs" >"$out/scale.csv"

awk "$suite_awk"'
function add(name, size, seconds) {
    if (seconds <= 0) return
    if (!(name in n)) order[++names] = name
    i = ++n[name]; x[name, i] = log(size); y[name, i] = log(seconds)
}
$1 == "photons" { add("photons.tracing", $2, $at["photons_s"]); add("photons.map", $2, $at["map_s"]) }
$1 == "pixels" || $1 == "gather" { add($1 ".render", $2, $at["render_s"]) }
$1 ~ /^(spheres|triangles|instances|materials|lamps)$/ {
    add($1 ".load", $2, $at["load_s"]); add($1 ".render", $2, $at["render_s"])
}
END {
    print "what,sizes,exponent,last_decade"
    for (k = 1; k <= names; k++) {
        s = order[k]; sx = sy = sxx = sxy = 0; m = n[s]
        for (i = 1; i <= m; i++) { sx += x[s, i]; sy += y[s, i]; sxx += x[s, i] ^ 2; sxy += x[s, i] * y[s, i] }
        printf "%s,%d,%.3f,%.3f\n", s, m, (m * sxy - sx * sy) / (m * sxx - sx * sx),
            (y[s, m] - y[s, m - 1]) / (x[s, m] - x[s, m - 1])
    }
}' "$out/scale.csv" >"$out/exponents.csv"
suite_json "$out/scale.csv"
suite_json "$out/exponents.csv"

suite_plot "$out/scale" <<PLOT
set logscale xy; set xlabel "photons, pixels, gather rays a pixel, spheres, triangles, instances, materials, lamps"; set ylabel "CPU seconds"
set key outside right; set title "How the time grows; grey: in proportion"
of(bench, column) = sprintf("< grep '^%s,' '$out/scale.csv' | cut -d, -f2,%d", bench, column)
plot of("photons", 4) using 1:2 with linespoints lw 2 title "photons: tracing", \
    of("photons", 5) using 1:2 with linespoints lw 2 title "photons: map", \
    of("pixels", 6) using 1:2 with linespoints lw 2 title "pixels: render", \
    of("gather", 6) using 1:2 with linespoints lw 2 title "gather rays: render", \
    of("spheres", 3) using 1:2 with linespoints lw 2 title "spheres: load", \
    of("spheres", 6) using 1:2 with linespoints lw 2 title "spheres: render", \
    of("triangles", 3) using 1:2 with linespoints lw 2 title "triangles: load", \
    of("triangles", 6) using 1:2 with linespoints lw 2 title "triangles: render", \
    of("instances", 3) using 1:2 with linespoints lw 2 title "instances: load", \
    of("materials", 3) using 1:2 with linespoints lw 2 title "materials: load", \
    of("lamps", 6) using 1:2 with linespoints lw 2 title "lamps: render", \
    1e-6 * x with lines lc rgb "#bbbbbb" dt 2 notitle, 1e-5 * x with lines lc rgb "#bbbbbb" dt 2 notitle
PLOT

while IFS=, read -r what _ _ last; do suite_ratio "scale.$what" "$last"; done < <(tail -n +2 "$out/exponents.csv")
# Counts, which no noise touches: every photon that was wanted, one camera ray a pixel, and no more gather rays than asked for.
suite_ratio scale.photons_missing "$(awk "$suite_awk"'
    $1 == "photons" { missing += $at["variant"] - $at["stored_global"] } END { print missing + 0 }' "$suite_runs")"
suite_ratio scale.camera_rays_each "$(awk "$suite_awk"'
    $1 == "pixels" { rays += $at["camera_rays"]; pixels += $at["variant"] } END { print rays / pixels }' "$suite_runs")"
suite_ratio scale.gather_rays_each "$(awk "$suite_awk"'
    $1 == "gather" { rays += $at["gather_rays"]; wanted += $at["variant"] * $at["camera_rays"] }
    END { print rays / wanted }' "$suite_runs")"
column -t -s, "$out/exponents.csv"
