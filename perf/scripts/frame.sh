#!/usr/bin/env bash
# frame.sh: the CPU time of a whole picture, process and photons and all, against what Embree alone needs for all its
# rays: the paper's room 20, 64 gather rays a pixel, with irradiance at all photons and at an eighth of them.
# Use: perf/scripts/frame.sh [--quick] [--repeats N] [--out DIR]
# Writes frame.csv and .json, runs.csv; embree_share is the part of the time that is Embree's. Embree traces as many
# gather rays from the same pixels (afterglow-frame-rays); camera, shadow and photon rays, and those that go on after a
# short one, count as if they took as long.
set -euo pipefail
# shellcheck source=perf/scripts/suite.sh
. "$(dirname "${BASH_SOURCE[0]}")/suite.sh"

suite_begin frame "usage: perf/scripts/frame.sh [options]
A whole picture's CPU time against Embree's for all its rays." "$@"
suite_no_more_options
suite_room 20
size=400 gather=64 arguments=(-t 1 --only indirect)
[[ $quick == yes ]] && size=40 gather=4 arguments+=(--photons 20000)
arguments+=(--size "${size}x$size" --gather-samples "$gather")

fractions=(1 0.125)
echo "fraction,repeat,rays,embree_us,embree_s,cpu_s,ratio" >"$out/frame_runs.csv"
for ((r = 1; r <= repeats; r++)); do
    for fraction in "${fractions[@]}"; do
        embree=$("$suite_bin/afterglow-frame-rays" "$room" "$size" "$gather" 2>/dev/null)
        suite_run frame "$fraction" "$r" "${arguments[@]}" --irradiance-fraction "$fraction" "$room"
        jq -r --arg fraction "$fraction" --arg repeat "$r" --arg us "${embree#*,}" \
            '(.rays | .camera + .shadow + .gather + .photon) as $rays | ($rays * ($us | tonumber) * 1e-6) as $s |
            [$fraction, $repeat, $rays, $us, $s, .cpu_s, .cpu_s / $s] | map(tostring) | join(",")' \
            "$suite_work/run.json" >>"$out/frame_runs.csv"
    done
done
awk "$suite_awk"'
{ f = $at["fraction"]; r = ++n[f]; rays[f] = $at["rays"]; cpu[f, r] = $at["cpu_s"]; embree[f, r] = $at["embree_s"]
  ratio[f, r] = $at["ratio"] }
END {
    print "fraction,runs,rays,embree_s,cpu_s,ratio,embree_share"
    fractions = split("1,0.125", name, ",")
    for (k = 1; k <= fractions; k++) {
        f = name[k]
        for (r = 1; r <= n[f]; r++) { a[r] = embree[f, r]; b[r] = cpu[f, r]; c[r] = ratio[f, r] }
        ratio_of = median(c, n[f])
        printf "%s,%d,%d,%.3f,%.3f,%.3f,%.2f\n", f, n[f], rays[f], median(a, n[f]), median(b, n[f]), ratio_of, 1 / ratio_of
    }
}' "$out/frame_runs.csv" >"$out/frame.csv"
suite_json "$out/frame.csv"
for fraction in "${fractions[@]}"; do
    suite_ratio "frame.fraction_$fraction" "$(awk -F, -v f="$fraction" '$1 == f { print $6 }' "$out/frame.csv")"
done
column -t -s, "$out/frame.csv"
