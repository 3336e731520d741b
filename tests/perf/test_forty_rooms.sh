#!/usr/bin/env bash
# The forty rooms' bookkeeping: every run is kept, turns alternate, ratios are of the same repeat, and the worst room is
# judged. The renderer is a stand-in that hands out the same small picture again and again; CPU times are made up.
set -euo pipefail
# shellcheck source=tests/fixtures/shell_test.sh
source "$(dirname "${BASH_SOURCE[0]}")/../fixtures/shell_test.sh"
need jq
program=$AFTERGLOW_BUILD_DIR/bin/afterglow-forty-rooms
need_benchmark afterglow-forty-rooms

cat >"$folder/renderer" <<'END'
#!/usr/bin/env bash
set -euo pipefail
kept=$(dirname "$0")/kept
while (($# > 1)); do
    case $1 in -o) picture=$2 ;; --stats) stats=$2 ;; esac
    shift
done
if [[ ! -e $kept.json ]]; then
    "$AFTERGLOW_PROGRAM" -q --progress none --only indirect --size 8x8 --photons 2000 \
        -o "$kept.exr" --stats "$kept.first" "$1"
    jq '.photons.stored_global = 500000' "$kept.first" >"$kept.json"
fi
cp "$kept.exr" "$picture"
cp "$kept.json" "$stats"
END
chmod +x "$folder/renderer"

out=$folder/out
measure() {
    "$program" --out "$out" --program "$folder/renderer" --rooms 1 "$@" >/dev/null || fail "it ended with $?: $*"
}
runs() { cut -d, -f1-5 "$out/runs.csv" | tail -n +2 | tr '\n' ' '; } # repeat,turn,room,gather,mode
expect_runs() { [[ $(runs) == "$1" ]] || fail "runs.csv holds $(runs)"; }

# --- every run, and who begins ---

two=(--modes "on-demand,precompute" --gathers 1 --repeats 3)
measure "${two[@]}"
pairs="1,1,1,1,on-demand 1,2,1,1,precompute 2,1,1,1,precompute 2,2,1,1,on-demand 3,1,1,1,on-demand 3,2,1,1,precompute "
expect_runs "$pairs"
[[ $(wc -l <"$out/results.csv") == 3 ]] || fail "results.csv has other than a heading and two lines"
awk -F, 'NR == 1 { n = NF } NF != n { bad = 1 } END { exit bad || n < 20 }' "$out/runs.csv" || fail "runs.csv is not whole"

measure "${two[@]}" --resume
expect_runs "$pairs"
# A line that got lost is measured again; what was not run together is no pair.
sed -i '/,precompute,/d' "$out/results.csv"
measure "${two[@]}" --repeats 1 --resume
expect_runs "${pairs}4,1,1,1,precompute "
measure "${two[@]}" --gathers 4 --repeats 1 --resume
expect_runs "${pairs}4,1,1,1,precompute 1,1,1,4,on-demand 1,2,1,4,precompute "

measure --gathers 1 --repeats 2
expect_runs "1,1,1,1,on-demand 1,2,1,1,precompute 1,3,1,1,off 2,1,1,1,precompute 2,2,1,1,on-demand "
[[ -s $out/runs.csv.old ]] || fail "the runs of before were not kept"

# --- the ratios: repeats on a machine that gets slower and slower, so that other repeats must not be compared ---

# results.csv has each mode's run of median time: by those, room 1 would be 1.2 times as fast at 1 ray instead of 1.4.
made=$folder/made
mkdir "$made"
make_up() { # FILE RUNS: lines for its heading; RUNS: not empty for runs.csv
    awk -v FS=, -v OFS=, -v is_runs="$2" '
    function field(name, room, gather, mode, repeat, cpu) {
        if (name == "repeat") return repeat
        if (name == "turn") return 1 + (mode == "precompute")
        if (name == "room") return room
        if (name == "gather") return gather
        if (name == "mode") return mode
        if (name == "cpu_s" || name == "sum_s") return cpu
        if (name == "share") return mode == "precompute" ? 1 : 0.75
        if (name == "identical") return is_runs ? "" : 1
        if (name == "stored" || name == "computed" || name == "distinct") return 500000
        return name == "duplicated" ? 0 : ""
    }
    function line(room, gather, mode, repeat, cpu,    i, text) {
        for (i = 1; i <= NF; i++) text = text (i > 1 ? "," : "") field($i, room, gather, mode, repeat, cpu)
        print text
    }
    function ratios(room, gather, a, b, c) {
        if (!is_runs) {
            line(room, gather, "on-demand", 0, 2)
            line(room, gather, "precompute", 0, 2 * b)
            return
        }
        line(room, gather, "on-demand", 1, 1); line(room, gather, "precompute", 1, a)
        line(room, gather, "on-demand", 2, 2); line(room, gather, "precompute", 2, 2 * b)
        line(room, gather, "on-demand", 3, 4); line(room, gather, "precompute", 3, 4 * c)
        line(room, gather, "precompute", 4, 99) # no pair
    }
    {
        print
        ratios(1, 1, 1.5, 1.2, 1.4); ratios(2, 1, 0.97, 0.97, 0.97)
        ratios(1, 4, 1.3, 1.3, 1.3); ratios(2, 4, 1.1, 1.1, 1.1)
        ratios(1, 16, 1.05, 1.05, 1.05); ratios(2, 16, 1.05, 1.05, 1.05)
        ratios(1, 64, 0.96, 0.96, 0.96); ratios(2, 64, 1.2, 0.94, 0.9)
        exit
    }' "$out/$1" >"$made/$1"
}
make_up results.csv ''
make_up runs.csv yes
"$program" --out "$made" --summary-only >/dev/null || fail "--summary-only ended with $?"
summary=$(sed -n '/repeat by repeat/,/^## Without/p' "$made/summary.md")
for line in "| 1 | 2 | 0.970 / 1.185 / 1.400 | 1 | 0 | 0.250 | 0.127 |" "| 4 | 2 | 1.100 / 1.200 / 1.300 | 0 | 0 |" \
    "| 64 | 2 | 0.940 / 0.950 / 0.960 | 2 | 1 |"; do
    [[ $summary == *"$line"* ]] || fail "summary.md has no line '$line': $summary"
done
mv "$made/runs.csv" "$folder/runs.csv" # an old measurement has none
"$program" --out "$made" --summary-only >/dev/null || fail "without runs.csv --summary-only ended with $?"
[[ $(<"$made/summary.md") == *"On demand against precompute"* && $(<"$made/summary.md") != *"repeat by repeat"* ]] ||
    fail "without runs.csv the summary is another"
mv "$folder/runs.csv" "$made/runs.csv"

# --- what run.sh judges, of the same lines ---

mkdir -p "$folder/build/bin" "$folder/tools"
cat >"$folder/build/bin/afterglow-forty-rooms" <<END
#!/usr/bin/env bash
echo "\$*" >>"$folder/calls"
mkdir -p "\$2" && cp "$made/results.csv" "$made/runs.csv" "\$2"
END
printf '#!/bin/sh\nexit 0\n' >"$folder/tools/gnuplot"
chmod +x "$folder/build/bin/afterglow-forty-rooms" "$folder/tools/gnuplot"
judge() {
    AG_BUILD_DIR=$folder/build AG_PROGRAM=$AFTERGLOW_PROGRAM AG_PERF_BUILD=no PATH=$folder/tools:$PATH \
        "$root/perf/scripts/run.sh" --parts forty_rooms --repeats 3 --out "$folder/judged" --results "$folder/report" \
        2>"$folder/errors"
}
status=0
judge >/dev/null || status=$?
((status == 1)) || fail "rooms that are too slow ended with $status"
for line in "speedup_1,1.185,at least,1.2,time,MISSED" "least_1,0.97,at least,1,time,MISSED" \
    "least_4,1.1,at least,1,time,met" "speedup_64,0.95,at least,0.95,time,met" \
    "least_64,0.94,at least,0.952,time,MISSED" "computed_more,0,at most,0,count,met"; do
    grep -qx "forty_rooms.$line" "$folder/report/verdicts.csv" || fail "no '$line': $(<"$folder/report/verdicts.csv")"
done
grep -q -- "--gathers 1,4,16 --repeats 3$" "$folder/calls" || fail "calls: $(<"$folder/calls")"
grep -q -- "--gathers 64 --repeats 13 --resume$" "$folder/calls" || fail "calls: $(<"$folder/calls")"

# a room without a pair must not pass
sed -i '/^[123],2,2,4,precompute/d' "$made/runs.csv"
judge >/dev/null || true
grep -q "^forty_rooms.least_4,0,.*,MISSED$" "$folder/report/verdicts.csv" || fail "a room without a pair passed"

printf '#!/bin/sh\nexit 3\n' >"$folder/tools/gnuplot"
judge >/dev/null || true
grep -q "forty_rooms failed" "$folder/errors" || fail "gnuplot's failure passed unnoticed"
