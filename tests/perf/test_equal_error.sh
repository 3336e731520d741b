#!/usr/bin/env bash
# equal_error.sh's quick form on two small scenes, with rivals: tables are whole, a rival that is path tracing is as good
# as path tracing, what has a bias shows it, what fails is named, and what is measured is not measured again.
set -euo pipefail
for tool in jq python3; do
    if ! command -v "$tool" >/dev/null; then
        echo "SKIPPED: $tool is not installed"
        exit 77
    fi
done
root=$(cd "$(dirname "${BASH_SOURCE[0]}")/../.." && pwd)
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
export AG_BUILD_DIR=$folder/build AG_PROGRAM=$AFTERGLOW_PROGRAM AG_PERF_BUILD=no
mkdir -p "$AG_BUILD_DIR"
ln -s "$AFTERGLOW_BUILD_DIR/bin" "$AG_BUILD_DIR/bin"
if [[ ! -x $AG_BUILD_DIR/bin/afterglow-pair-error ]]; then
    echo "SKIPPED: the benchmarks are not built"
    exit 77
fi
fail() {
    echo "$*" >&2
    exit 1
}

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
        [[ $method == photonmap ]] || # whose photons alone may take longer
            holds "$(figure $scene $method cpu_s) > 0.15 && $(figure $scene $method cpu_s) < 1.2" "CPU time of $scene, $method"
        holds "$(figure $scene $method trimmed_error) < $(figure $scene $method error)" "trimmed, $scene, $method"
        holds "$(figure $scene $method mean_ratio) > 0.9 && $(figure $scene $method mean_ratio) < 1.1" "mean of $scene"
    done
    [[ $(figure $scene photonmap over_photonmap) == 1 ]] || fail "the photon map is not as good as itself"
done
# the same program by another name: the noise of few runs, and what starting it costs
for a in same,path path,same; do
    holds "$(figure box_with_blocks ${a%,*} error) < 3 * $(figure box_with_blocks ${a#*,} error)" "a rival that is path tracing"
done
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
expect_error "there is no scene 'nowhere'" nowhere

# the arithmetic of intervals and of samples, by hand
PYTHONPATH=$root/perf/scripts python3 -B - <<'CHECK'
from equal_error import interval_of_median, samples_for
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
CHECK
