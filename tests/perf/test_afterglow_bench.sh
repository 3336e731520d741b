#!/usr/bin/env bash
# afterglow-bench's quick form: its certificate holds for any number of threads and processors, its files are whole, two
# results are compared, and mistakes are told. Nothing is timed.
set -euo pipefail
# shellcheck source=tests/fixtures/shell_test.sh
source "$(dirname "${BASH_SOURCE[0]}")/../fixtures/shell_test.sh"
need jq
program=$AFTERGLOW_BUILD_DIR/bin/afterglow-bench
cd "$folder"

# more threads than processors, too: the bits and counts of one thread
"$program" --quick -q --threads 1,2,3,64 -o a.json -o a.html >line 2>told || {
    code=$?
    ! grep -q 'known to make other bits' told || fail "bench_known.c's row 'quick' is out of date: $(jq .certificate.hash a.json)"
    fail "--quick ended with $code: $(<told)"
}
# the row of this build; a new version has a new one
build=$(jq -r '.build | [.compiler, .embree, .libm, .isa, .maker] | join(", ")' a.json)
[[ $build != "gcc 12.2.0, 3.13.5, glibc 2.36, avx2, AuthenticAMD" || $(jq -r .certificate.known_build a.json) == matches ]] ||
    fail "bench_known.c has no row 'quick' of this version: $(jq .certificate.hash a.json)"
[[ $(wc -l <line) == 1 ]] && grep -q '^| .* | quick | - | - | valid, [0-9a-f]\{8\} |$' line || fail "the line is: $(<line)"
grep -q 'the quick size times nothing' told || fail "it does not say why there is no score: $(<told)"
jq -e '.program == "afterglow-bench" and .format == 1 and .size == "quick" and .score_one == null and .score_best == null
    and .certificate.valid and .certificate.duplicated == 0 and (.certificate.reasons | length) == 0
    and (.certificate.hash | test("^[0-9a-f]{32}$")) and .busy == false
    and .machine.cores >= 1 and .machine.threads >= .machine.cores and .machine.numa_nodes >= 1
    and (.build | .sources, .compiler, .embree, .libm, .isa | length > 0)
    and [.levels[].threads] == [1, 2, 3, 64] and .levels[-1].oversubscribed
    and ([.parts[] | select(.threads == 1)] | length) == 24
    and ([.parts[] | select(.phase == "frame")] | length) == 12
    and all(.parts[]; .rate.median > 0 and .units >= 1 and .duplicated == 0)
    and all(.parts[] | select(.phase == "frame"); .computed == .count and .requests > .computed and .cache_hits > 0)
    and all([.parts[] | {key: (.scene + " " + .phase), hash, count}] | group_by(.key)[]; unique | length == 1)
    and ([.parts[] | select(.threads == 1) | .hash] | unique | length) == 24' \
    a.json >/dev/null || fail "a.json is not as it should be: $(jq -c 'del(.parts)' a.json)"
grep -q '</html>' a.html && ! grep -qE 'https?:|<script|nan' a.html || fail "a.html is no page by itself"
echo "ok: a run"

# one processor: the machine is smaller, the bits are not others
if command -v taskset >/dev/null; then
    taskset -c "$(taskset -cp $$ | sed -E 's/.*: ([0-9]+).*/\1/')" "$program" --quick -q --threads 2 -o b.json >/dev/null 2>&1 ||
        fail "on one processor it ended with $?"
    jq -e '.machine.threads == 1 and .machine.threads_allowed == 1 and [.levels[].oversubscribed] == [false, true]' b.json >/dev/null ||
        fail "one processor: $(jq -c '.machine, .levels' b.json)"
    [[ $(jq .certificate.hash a.json) == "$(jq .certificate.hash b.json)" ]] || fail "one processor makes other bits"
else
    cp a.json b.json
fi
expect 0 'Both made the same bits.' "$program" compare a.json b.json
grep -qE '^room +frame +1 ' said || fail "no line of frames: $(<said)"
jq '.certificate.hash = "0"' b.json >other.json
expect 0 'They made different bits' "$program" compare a.json other.json
echo "ok: one processor, compared"

# what cannot be compared
jq '.size = "large"' a.json >large.json
expect 1 'are of different work' "$program" compare a.json large.json
head -c 500 a.json >cut.json
expect 1 'cut.json:' "$program" compare a.json cut.json
echo '{}' >none.json
expect 1 'none.json: error: no result of afterglow-bench' "$program" compare none.json a.json
expect 1 'nowhere.json' "$program" compare a.json nowhere.json

# mistakes are told before anything is measured
expect 2 "'--slow' is no option" "$program" --slow
expect 2 "--size: 'huge' is no value of it" "$program" --size huge
expect 2 '--threads wants a value' "$program" --threads
expect 2 "--threads: '0' is no value of it" "$program" --threads 0
expect 2 "-o: 'a.txt' is no value of it" "$program" -o a.txt
expect 2 'compare wants two files' "$program" compare a.json
expect 3 'no-such-folder' "$program" --quick -o no-such-folder/a.json
expect 0 'usage: afterglow-bench' "$program" --help
expect 0 'afterglow-bench ' "$program" --version

# the man page tells of the same options
"$program" --help | sed -nE 's/^ {2}((-., )?--?[^ ]+( [A-Z]+)?) {2}.*$/\1/p' | sort >help
page=$AFTERGLOW_BUILD_DIR/perf/afterglow-bench.1
awk 'before == ".TP" { print } { before = $0 }' "$page" | sed -nE 's/\\f.//g; s/\\-/-/g; /^-/p' | sort >page
[[ $(wc -l <help) == 8 ]] && diff -u help page || fail "the man page and --help differ"
if command -v groff >/dev/null; then
    groff -man -ww -z "$page" 2>warnings
    [[ ! -s warnings ]] || fail "roff: $(<warnings)"
fi

# a file is there whole or not at all: a full disk leaves the one before
cp a.json before.json
(
    ulimit -f 1
    trap '' XFSZ
    "$program" --quick -q --threads 1 -o a.json >/dev/null 2>told
) && fail "a result was written to a full disk"
cmp -s a.json before.json || fail "the result of before is gone"
[[ -z $(find . -name '.a.json*') ]] || fail "a part of a file is left"
echo "ok: mistakes"
