#!/usr/bin/env bash
# equal_error.sh's quick form on two small scenes, with rivals: tables are whole, a rival that is path tracing is as good
# as path tracing, what has a bias shows it, what fails is named, and what is measured is not measured again.
set -euo pipefail
# shellcheck source=tests/fixtures/shell_test.sh
source "$(dirname "${BASH_SOURCE[0]}")/../fixtures/shell_test.sh"
need jq python3
export AG_BUILD_DIR=$folder/build AG_PROGRAM=$AFTERGLOW_PROGRAM AG_PERF_BUILD=no
mkdir -p "$AG_BUILD_DIR"
ln -s "$AFTERGLOW_BUILD_DIR/bin" "$AG_BUILD_DIR/bin"
need_benchmark afterglow-pair-error

box=$root/tests/scenes/box_with_blocks.pbrt lamp=$root/tests/scenes/lamp_sphere.pbrt
path="'$AG_PROGRAM' -q --noise 0 --integrator path --type float --size {width}x{height} --seed {seed} -o {out}"
measure() { "$root/perf/scripts/equal_error.sh" --quick --threads 1 --out "$folder/out" "$@"; }
measure --rival "same=$path --spp {spp} {scene}" --rival "dim=$path --spp 64 --max-depth 1 {scene} # {seconds}" \
    "$box" "$lamp" >"$folder/said" || fail "it ended with $?"

# a row for each scene and method; every line has as many fields as the heading
awk -F, 'NR == 1 { fields = NF } NF != fields { print "line " NR ": " $0; bad = 1 } END { exit bad || NR != 9 }' \
    "$folder/out/equal_error.csv" >&2 || fail "equal_error.csv is not whole"
figure() { # SCENE METHOD COLUMN
    jq -r --arg scene "$1" --arg method "$2" --arg column "$3" \
        '.[] | select(.scene == $scene and .method == $method) | .[$column]' "$folder/out/equal_error.json"
}
holds() { awk "BEGIN { exit !($1) }" || fail "$2: $1"; }
for scene in box_with_blocks lamp_sphere; do
    for method in photonmap path same; do
        holds "$(figure $scene $method cpu_s) > 0" "CPU time of $scene, $method"
        holds "$(figure $scene $method trimmed_error) < $(figure $scene $method error)" "trimmed, $scene, $method"
        holds "$(figure $scene $method mean_ratio) > 0.9 && $(figure $scene $method mean_ratio) < 1.1" "mean of $scene"
    done
    [[ $(figure $scene photonmap over_photonmap) == 1 ]] || fail "the photon map is not as good as itself"
done
# the same program by another name has the same error for a sample; how many samples it got is a matter of time
runs_of() { # METHOD: error and number of samples of each pair of box_with_blocks
    awk -F, -v method="$1" 'NR == 1 { for (i = 1; i <= NF; i++) column[$i] = i }
        $column["scene"] == "box_with_blocks" && $column["method"] == method { print $column["error"], $column["spp"] }' "$folder/out/runs.csv"
}
error_of_a_sample() { # METHOD: mean over the pairs
    runs_of "$1" | awk '{ sum += $1 * $2; n++ } END { if (n == 0) exit 1; print sum / n }'
}
path_error=$(error_of_a_sample path) same_error=$(error_of_a_sample same)
echo "error of a sample: path $path_error, rival $same_error"
holds "$same_error < 1.5 * $path_error && $path_error < 1.5 * $same_error" "a rival that is path tracing"
# without indirect light a closed box is too dark: nearly all of the error is bias; a floor alone has no such light
holds "$(figure box_with_blocks dim mean_ratio) < 0.9" "direct light alone"
holds "$(figure box_with_blocks dim bias_squared) > 0.8 * $(figure box_with_blocks dim error)" "direct light alone"
holds "$(figure lamp_sphere dim mean_ratio) > 0.98" "direct light of a floor"
python3 -c 'import sys, xml.etree.ElementTree as e; t = e.parse(sys.argv[1]); sys.exit(0 if len(t.findall(".//{*}polyline")) == 16 else 1)' \
    "$folder/out/equal_error.svg" || fail "the plot has not a line for each method, whole and trimmed, in each panel"
grep -q '^| box_with_blocks | 0.4 | path |' "$folder/said" || fail "the table is not shown"

# what is there is kept: no picture is rendered, for there is no program
cp "$folder/out/equal_error.csv" "$folder/before.csv"
AG_PROGRAM=/bin/false measure --resume --rival "same=false {scene} {out} {seed} {spp}" \
    --rival "dim=false {scene} {out} {seed} {spp}" "$box" "$lamp" >/dev/null || fail "--resume measures again"
cmp "$folder/before.csv" "$folder/out/equal_error.csv" || fail "--resume told other figures"

# at defaults the photon map ends by itself, with no number of samples to tell, and all else has 64
measure --seconds 0 --pairs 1 --rival "same=$path --spp {spp} {scene}" "$box" >"$folder/said" || fail "at defaults it ended with $?"
for method in photonmap path same; do
    read -r _ samples <<<"$(runs_of "$method")"
    [[ $samples == $([[ $method == photonmap ]] && echo 0 || echo 64) ]] || fail "$method had $samples samples at defaults"
    grep -q "^| box_with_blocks | defaults | $method |" "$folder/said" || fail "the table does not tell of $method at defaults"
done

expect_error() { # TEXT ARGUMENTS...
    local text=$1 status=0
    shift
    measure "$@" >/dev/null 2>"$folder/errors" || status=$?
    ((status == 1)) || fail "$* ended with $status"
    grep -qF "$text" "$folder/errors" || fail "'$text' is not in: $(<"$folder/errors")"
}
expect_error "of other sizes or references" --resume --width 16 "$box"
expect_error "'broken' failed with 3" --rival "broken=exit 3 # {scene} {out} {seed} {spp}" "$lamp"
expect_error "has neither {seconds} nor {spp}" --rival "idle=true {scene} {out} {seed}" "$lamp"
expect_error "the command of 'idle' has no {out}" --rival "idle=true {scene} {seed} {spp}" "$lamp"
expect_error "with a name that is not taken" --rival "path=$path --spp {spp} {scene}" "$lamp"
expect_error "the command of 'timed' has no {spp}, and ends by no defaults" --seconds 0 --rival "timed=true {scene} {out} {seed} {seconds}" "$lamp"
expect_error "there is no scene 'nowhere'" nowhere

# the arithmetic of intervals and of samples, by hand, and the search for samples with a clock that is a formula
PYTHONPATH=$root/perf/scripts python3 -B - "$folder" <<'CHECK'
import argparse, sys
from pathlib import Path
import equal_error
from equal_error import interval_of_median, run_pair, samples_for
# eight values: the second and the seventh hold the median with 1 - 2 (1 + 8) / 256
assert interval_of_median([8, 1, 7, 2, 6, 3, 5, 4]) == (4.5, 2, 7, 1 - 18 / 256)
assert interval_of_median([3]) == (3, 3, 3, 0.0)
assert interval_of_median([1, 5, 2])[:3] == (2, 1, 5)
# 2 s at once and 0.5 s a sample; by the nearest two; never more than eight times as many
assert samples_for(10, [(4, 4.0)]) == 32
assert samples_for(10, [(4, 4.0), (8, 6.0)]) == 16
assert samples_for(10, [(4, 4.0), (8, 6.0), (100, 1000.0)]) == 16
assert samples_for(1000, [(4, 4.0), (8, 6.0)]) == 64
assert samples_for(1, [(4, 4.0), (8, 6.0)]) == 1
assert samples_for(3, [(4, 4.0), (2, 4.1)]) == 1 # noise: fewer
assert samples_for(5, [(4, 4.0), (2, 4.1)]) == 32 # noise: more
assert samples_for(5, [(4, 4.9), (6, 4.8), (30, 9.0)]) == 30 # noise, but 30 are too many
assert samples_for(5, [(4, 4.0), (9, 5.2), (10, 5.3)]) == 7
assert samples_for(5, [(4, 4.0), (9, 5.5), (10, 5.6)]) == 4 # no fewer than what was too quick
class Formula: # a method that takes 0.3 s at once and 0.02 s a sample
    name, takes_samples = "formula", True
    def render(self, job, seed, out, seconds=0.0, spp=0):
        Path(out).touch()
        return 0.3 + 0.02 * spp
equal_error.picture_errors = lambda bin_folder, pictures, references: {}
job = argparse.Namespace(name="none", size="1x1")
options = argparse.Namespace(work=sys.argv[1], reference_spp=1, bin="")
known = []
for pair, seconds in ((1, 0.5), (1, 10.0), (2, 10.0)):
    row = run_pair(options, job, Formula(), seconds, pair, known, [])
    assert abs(float(row["cpu_s"]) / seconds - 1.0) <= equal_error.NEAR_ENOUGH, row
    assert float(row["cpu_s"]) == round(0.3 + 0.02 * row["spp"], 4), row
CHECK
