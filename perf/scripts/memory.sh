#!/usr/bin/env bash
# memory.sh: bytes a photon once the map is built and at the peak on the way there, and CPU time a photon against a map
# of one million, for 1, 10 and 100 million photons, as far as there is memory for them; bytes a triangle of ten million.
# Use: perf/scripts/memory.sh [--quick] [--repeats N] [--out DIR] [--photons LIST]
# Writes memory.csv and .json, triangles.csv.
set -euo pipefail
# shellcheck source=perf/scripts/suite.sh
. "$(dirname "${BASH_SOURCE[0]}")/suite.sh"

suite_begin memory "usage: perf/scripts/memory.sh [options]
Memory and time a photon. 100 million photons are tried where 12 GiB are free.
  --photons L  other numbers of photons, by commas; the first is what the others are held against" "$@"
counts=1000000,10000000,100000000
[[ $quick == yes ]] && counts=20000,200000
if [[ ${suite_rest[0]:-} == --photons ]]; then
    counts=${suite_rest[1]:?--photons wants a list}
    suite_rest=("${suite_rest[@]:2}")
fi
suite_no_more_options
[[ $counts =~ ^[0-9]+(,[0-9]+)*$ ]] || suite_fail "--photons wants numbers by commas, not '$counts'"
suite_room 20
echo "photons,bytes_each,peak_bytes_each,tracing_us_each,map_us_each,repeat" >"$out/runs.csv"
for ((r = 1; r <= repeats; r++)); do
    for n in ${counts//,/ }; do
        free_gib=$(awk '/^MemAvailable/ { print int($2 / 1048576) }' /proc/meminfo)
        if ((n > 10000000 && free_gib < n / 8333333)); then
            echo "memory: left out: $n photons: $free_gib GiB are free" >&2
            continue
        fi
        line=$("$suite_bin/afterglow-photon-memory" "$room" "$n" 0)
        echo "$line,$r" >>"$out/runs.csv"
    done
done

awk -v first="${counts%%,*}" "$suite_awk"'
{
    k = $1; r = ++n[k]
    if (r == 1) order[++keys] = k
    bytes[k] = $2; peak[k] = $3 > peak[k] ? $3 : peak[k]; tracing[k, r] = $4; map[k, r] = $5
}
END {
    print "photons,runs,bytes_each,peak_bytes_each,tracing_us_each,map_us_each,time_against_first"
    for (i = 1; i <= keys; i++) {
        k = order[i]
        for (r = 1; r <= n[k]; r++) {
            a[r] = tracing[k, r]; b[r] = map[k, r]
            c[r] = (tracing[k, r] + map[k, r]) / (tracing[first, r] + map[first, r])
        }
        printf "%d,%d,%.2f,%.2f,%.4f,%.4f,%.3f\n", k, n[k], bytes[k], peak[k], median(a, n[k]), median(b, n[k]), median(c, n[k])
    }
}' "$out/runs.csv" >"$out/memory.csv"
suite_json "$out/memory.csv"
suite_ratio memory.bytes "$(awk -F, 'NR > 1 && $3 > max { max = $3 } END { print max }' "$out/memory.csv")"
if [[ $quick == no ]]; then # small maps sit in pages that are large against them
    suite_ratio memory.peak_bytes "$(awk -F, 'NR > 1 && $4 > max { max = $4 } END { print max }' "$out/memory.csv")"

    # triangles: what ten million take at the peak of loading and rendering more than a million do
    echo "triangles,peak_bytes" >"$out/triangles.csv"
    for n in 1000000 10000000; do
        mkdir -p "$suite_work/triangles-$n"
        "$suite_bin/afterglow-large-scene" triangles "$n" "$suite_work/triangles-$n"
        "$suite_program" -q --progress none --integrator path --spp 1 -o "$suite_work/run.exr" \
            --stats "$suite_work/run.json" "$suite_work/triangles-$n/triangles.pbrt"
        echo "$n,$(jq .memory.peak_bytes "$suite_work/run.json")" >>"$out/triangles.csv"
    done
    suite_ratio memory.triangle_bytes "$(awk "$suite_awk"'
        { n[FNR] = $1; bytes[FNR] = $2 } END { printf "%.1f", (bytes[3] - bytes[2]) / (n[3] - n[2]) }' "$out/triangles.csv")"
fi
suite_ratio memory.time_growth "$(awk -F, 'NR > 1 && $7 > max { max = $7 } END { print max }' "$out/memory.csv")"
column -t -s, "$out/memory.csv"
