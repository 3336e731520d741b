#!/usr/bin/env bash
# The benchmark suite's quick form: its files are whole, its counts are right, its verdict is kept. Nothing is timed.
set -euo pipefail
# shellcheck source=tests/fixtures/shell_test.sh
source "$(dirname "${BASH_SOURCE[0]}")/../fixtures/shell_test.sh"
need jq
export AG_BUILD_DIR=$AFTERGLOW_BUILD_DIR AG_PROGRAM=$AFTERGLOW_PROGRAM AG_PERF_BUILD=no
need_benchmark afterglow-photon-memory

"$root/perf/scripts/run.sh" --quick --out "$folder/out" --results "$folder/report" || fail "run.sh --quick ended with $?"

# every line of a table has as many fields as its heading, and there are as many lines as the work asks for
expect() { # FILE LINES
    local file=$folder/report/$1 lines
    [[ -s $file ]] || fail "$1 is missing"
    awk -F, 'NR == 1 { fields = NF } NF != fields { print FILENAME ": line " NR ": " $0; bad = 1 } END { exit bad }' \
        "$file" >&2 || fail "$1 is not whole"
    lines=$(($(wc -l <"$file") - 1))
    (($2 == lines || $2 == 0 && lines > 0)) || fail "$1 has $lines lines instead of $2"
}
expect verdicts.csv 0
expect frame.csv 2
expect scaling.csv 0
expect waiting.csv 0
expect exponents.csv 14
expect scale.csv 16
expect contention.csv 3
expect memory.csv 2
expect error.csv 2
expect equal_error.csv 1
jq -e 'length > 20' "$folder/report/verdicts.json" >/dev/null || fail "verdicts.json is not whole"
grep -q '^## Verdict' "$folder/report/report.md" || fail "report.md has no verdict"

# the counts, taken from the tables themselves
verdict() { awk -F, -v name="$1" '$1 == name { print $2 "," $6 }' "$folder/report/verdicts.csv"; }
for name in scaling.pixels_differing scaling.computed_differing scaling.duplicated contention.duplicated scale.photons_missing; do
    [[ $(verdict $name) == 0,met ]] || fail "$name: '$(verdict $name)'"
done
[[ $(verdict scale.camera_rays_each) == 1,met ]] || fail "camera rays: '$(verdict scale.camera_rays_each)'"
for name in scaling.work scaling.photons scaling.render; do
    [[ $(verdict $name) == [0-9]*",not judged" ]] || fail "$name: '$(verdict $name)': time is judged in the quick form, or not told"
done
awk -F, '$1 == "64-on-2" && $2 == 64 && $6 > 0 && $9 == 0 && $10 == 0 { found = 1 } END { exit !found }' \
    "$folder/report/contention.csv" || fail "contention.csv: not 64 threads, or not each once"

# a bound that is not met ends in exit code 1 and is named
copy=$folder/copy
mkdir -p "$copy"
cp -r "$root/perf" "$copy/perf"
# shellcheck disable=SC2016 # markdown's own marks
sed -i 's/^| `memory.bytes` | at most | [0-9.]* | count/| `memory.bytes` | at most | 1 | count/' "$copy/perf/README.md"
status=0
"$copy/perf/scripts/run.sh" --quick --parts memory --out "$folder/out2" --results "$folder/report2" 2>"$folder/errors" || status=$?
((status == 1)) || fail "a missed bound ended with $status"
grep -q 'memory.bytes is .* wanted at most 1' "$folder/errors" || fail "the missed bound is not named"

# a bound without a figure is not measured, which is a failure in the quick form too when it is a count
# shellcheck disable=SC2016 # markdown's own marks
sed -i '/^| `memory.bytes`/a | `memory.nothing` | at most | 1 | count | |' "$copy/perf/README.md"
status=0
"$copy/perf/scripts/run.sh" --quick --report-only --parts memory --out "$folder/out2" --results "$folder/report2" \
    2>"$folder/errors" || status=$?
((status == 1)) || fail "a bound without a figure ended with $status"
grep -q 'memory.nothing is not measured' "$folder/errors" || fail "the bound without a figure is not named"
grep -qx 'memory.nothing,,at most,1,count,NOT MEASURED' "$folder/report2/verdicts.csv" || fail "verdicts.csv lacks memory.nothing"
if grep -q 'memory.peak_bytes' "$folder/errors"; then fail "the quick form wants the peak"; fi

# programs that fail, give no rows, or are not there; --report-only still knows; the machine's report is left alone
mkdir -p "$folder/fake/bin"
printf '#!/bin/sh\necho what,us,us_least,ratio,of,at_most,holds\nexit 3\n' >"$folder/fake/bin/afterglow-gather-rays"
printf '#!/bin/sh\necho what,us,us_least,ratio,of,at_most,holds\n' >"$folder/fake/bin/afterglow-photon-making"
chmod +x "$folder/fake/bin/"*
for only in "" --report-only; do
    status=0
    # shellcheck disable=SC2086 # no option where it is empty
    AG_BUILD_DIR=$folder/fake "$copy/perf/scripts/run.sh" $only --parts gather_rays,photon_making,photon_search \
        --out "$folder/out3" 2>"$folder/errors" || status=$?
    ((status == 1)) || fail "failing programs ended with $status $only"
    for what in "gather_rays failed" "photon_making failed" "photon_search is not measured"; do
        grep -q "error: $what" "$folder/errors" || fail "not told: $what $only"
    done
done
[[ -s $folder/out3/report/report.md ]] || fail "--parts: no report in the folder of --out"
diff -r "$root/perf/results" "$copy/perf/results" >&2 || fail "--parts has changed the machine's report"

# what a busy machine leaves unknown is counted
mkdir -p "$folder/out4/thread_scaling"
{
    echo scaling.machine_share,0.5
    # shellcheck disable=SC2016 # markdown's own marks
    sed -n 's/^| `\(scaling[^`]*\)` | [a-z ]* | \([0-9.]*\) |.*/\1,\2/p' "$copy/perf/README.md"
} >"$folder/out4/thread_scaling/ratios.csv"
"$copy/perf/scripts/run.sh" --report-only --parts thread_scaling --out "$folder/out4" || fail "a busy machine ended with $?"
unknown=$(grep -c ',wall,not known' "$folder/out4/report/verdicts.csv") || fail "no bound is unknown"
grep -q "^Not known.*: $unknown of" "$folder/out4/report/report.md" || fail "what is not known is not counted"
if grep -q 'All bounds are met' "$folder/out4/report/report.md"; then fail "unknown bounds are told as met"; fi
