#!/usr/bin/env bash
# contention.sh: the paper's room with a cold cache, all threads asking at once: the CPU time that goes into waiting for
# another thread's estimate, with as many threads as cores, and with 64 threads on two cores; nothing is computed twice.
# Use: perf/scripts/contention.sh [--quick] [--repeats N] [--out DIR]
# Writes contention.csv and .json, runs.csv. Exit code 1 when an irradiance was computed twice.
set -euo pipefail
# shellcheck source=perf/scripts/suite.sh
. "$(dirname "${BASH_SOURCE[0]}")/suite.sh"

suite_begin contention "usage: perf/scripts/contention.sh [options]
Waiting in a cold cache, with as many threads as cores and with 64 threads on two cores." "$@"
suite_no_more_options
suite_room 20
arguments=("$room" --only indirect --gather-samples 16)
[[ $quick == yes ]] && arguments=("$room" --only indirect --gather-samples 4 --size 48x48 --photons 20000)

two_cores=() # the first two that we may use; a list like 0-3,8
if ((suite_cores > 2)); then
    command -v taskset >/dev/null || suite_fail "taskset is not installed (Debian: util-linux)"
    two_cores=(taskset -c "$(taskset -cp $$ | sed 's/.*: //' | tr , '\n' |
        awk -F- '{ for (i = $1; i <= $NF && n < 2; i++) list = list (n++ ? "," : "") i } END { print list }')")
fi
renderer=$suite_program
pinned=$suite_work/afterglow-on-two-cores
{
    echo '#!/bin/sh'
    echo "exec ${two_cores[*]} '$renderer' \"\$@\""
} >"$pinned"
chmod +x "$pinned"
for ((r = 1; r <= repeats; r++)); do
    suite_run contention cores "$r" -t "$suite_cores" "${arguments[@]}"
    suite_program=$pinned suite_run contention 64-on-2 "$r" -t 64 "${arguments[@]}"
    suite_run contention one "$r" -t 1 "${arguments[@]}"
done

# writes: what is written to lines that others read, per frame: a claim and a publication for each estimate.
awk "$suite_awk"'
{
    v = $at["variant"]; r = ++n[v]; threads[v] = $at["threads"]
    share[v, r] = $at["wait_s"] / $at["cpu_s"]; cpu[v, r] = $at["cpu_s"]; render[v, r] = $at["render_cpu_s"]
    requests[v] += $at["requests"]; computed[v] += $at["computed"]; deferred[v] += $at["deferred"]
    waited[v] += $at["waited"]; duplicated[v] += $at["duplicated"]; lost[v] += $at["computed"] - $at["distinct"]
    stored[v] = $at["stored_global"]
}
END {
    print "case,threads,runs,stored,requests,computed,deferred,waited,duplicated,lost,waiting_share,cpu_s,render_cpu_s,writes,writes_per_slot_line"
    cases = split("one,cores,64-on-2", name, ",")
    for (k = 1; k <= cases; k++) {
        v = name[k]
        for (r = 1; r <= n[v]; r++) { s[r] = share[v, r]; c[r] = cpu[v, r]; d[r] = render[v, r] }
        printf "%s,%d,%d,%d,%d,%d,%.1f,%.1f,%d,%d,%.3g,%.4f,%.4f,%d,%.2f\n", v, threads[v], n[v], stored[v],
            requests[v] / n[v], computed[v] / n[v], deferred[v] / n[v], waited[v] / n[v], duplicated[v], lost[v],
            median(s, n[v]), median(c, n[v]), median(d, n[v]), 2 * computed[v] / n[v],
            2 * computed[v] / n[v] / (stored[v] / 16)
    }
}' "$suite_runs" >"$out/contention.csv"
suite_json "$out/contention.csv"
for name in cores 64-on-2; do
    suite_ratio "contention.$name" "$(awk -F, -v name=$name '$1 == name { print $11 }' "$out/contention.csv")"
done
suite_ratio contention.duplicated "$(awk -F, 'NR > 1 { sum += $9 + ($10 < 0 ? -$10 : $10) } END { print sum + 0 }' "$out/contention.csv")"
column -t -s, "$out/contention.csv"
[[ $(tail -n 1 "$out/ratios.csv") == contention.duplicated,0 ]] || suite_fail "an irradiance was computed twice"
