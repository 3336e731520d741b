#!/bin/bash
# The irradiance slot's protocol, between threads, between processes that die, and between processes of several threads,
# checked exhaustively by spin; and that spin catches it when it is broken.
# Exit 77 (skipped) where spin is not installed.
set -u
models=$(cd "$(dirname "$0")" && pwd)
model=$models/irradiance_slot.pml
command -v spin >/dev/null || { echo "spin is not installed: skipped"; exit 77; }
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$folder" || exit 1
failures=0

# check NAME EXPECTED(holds|fails) COMPILE_FLAGS RUN_FLAGS [SPIN_FLAGS...]: pan says "errors: 0" where all holds;
# a search that was cut short does not count.
check() {
    local name=$1 expected=$2 compile=$3 run=$4
    shift 4
    # shellcheck disable=SC2086
    if ! { spin -a "$@" "$model" && ${CC:-cc} -O2 -w $compile -DMEMLIM=1024 pan.c -o pan; } >spin.log 2>&1; then
        echo "FAILED: $name: the model does not build"
        cat spin.log
        failures=$((failures + 1))
        return
    fi
    # shellcheck disable=SC2086
    ./pan -m100000 $run >pan.log 2>&1
    local outcome=unclear
    if grep -q "errors: 0" pan.log; then
        outcome=holds
    elif grep -q "errors: [1-9]" pan.log; then
        outcome=fails
    fi
    if [ $outcome = holds ] && grep -Eq "max search depth too small|Search not completed|out of memory" pan.log; then
        outcome=incomplete
    fi
    if [ $outcome = "$expected" ]; then
        echo "ok: $name $outcome ($(grep -Eo '[0-9.e+]+ states, stored' pan.log | head -1))"
    else
        echo "FAILED: $name: expected that it $expected, but: $outcome"
        cat pan.log
        failures=$((failures + 1))
    fi
}

safety="-DSAFETY -DNOCLAIM"
liveness="-DNFAIR=3"

check "no assertion fails, no deadlock" holds "$safety" ""
check "every request ends" holds "$liveness" "-a -f -N every_request_ends"
check "what is ready stays ready" holds "" "-a -N ready_is_final"

check "a claim that is not atomic: safety" fails "$safety" "" -DBROKEN_CLAIM
check "a claim that is never released: liveness" fails "$liveness" "-a -f -N every_request_ends" -DBROKEN_RELEASE
check "a claim held while waiting: liveness" fails "$liveness" "-a -f -N every_request_ends" -DBROKEN_NESTING

model=$models/irradiance_slot_shared.pml
liveness="-DNFAIR=6"
three="-DFIRST=3 -DSLOTS=1 -DREQUESTS=1"
check "processes that die: nothing twice, no claim lost, no deadlock" holds "$safety" ""
# shellcheck disable=SC2086
check "the same, of four" holds "$safety" "" $three
check "processes that die: all others end" holds "$liveness" "-a -f -N all_end"
check "processes that die: what is ready stays ready" holds "" "-a -N ready_is_final"
# shellcheck disable=SC2086
check "processes that are stopped: a value is published once" holds "$safety" "" -DSTOPS $three
check "processes that are stopped: all end" holds "$liveness" "-a -f -N all_end" -DSTOPS
check "processes that are stopped: what is ready stays ready" holds "" "-a -N ready_is_final" -DSTOPS

# shellcheck disable=SC2086
check "an entry without generations: safety" fails "$safety" "" -DBROKEN_GENERATION $three
check "a claim taken over without comparing: safety" fails "$safety" "" -DBROKEN_TAKE_OVER
check "a value published without comparing: safety" fails "$safety" "" -DBROKEN_PUBLISH -DSTOPS
check "the dead are not found: liveness" fails "$liveness" "-a -f -N all_end" -DBROKEN_LOCK

model=$models/irradiance_slot_threads.pml
one="-DPROCESSES=1 -DDEATHS=0"
two="-DPROCESSES=2 -DDEATHS=1 -DWORKERS=3"
check "two processes of two threads, one dies: nothing twice, no claim lost" holds "$safety" ""
# shellcheck disable=SC2086
check "processes of two threads and of one: all others end" holds "$liveness" "-a -f -N all_end" $two
# shellcheck disable=SC2086
check "processes of two threads and of one: what is ready stays ready" holds "" "-a -N ready_is_final" $two
# shellcheck disable=SC2086
check "a process with a new number: one waiting thread computes anew" holds "$safety" "" -DPATIENCE=1 $two
# shellcheck disable=SC2086
check "three threads of a process with a new number: the same" holds "$safety" "" -DPATIENCE=1 -DWORKERS=3 $one
# shellcheck disable=SC2086
check "a process with a new number: all others end" holds "$liveness" "-a -f -N all_end" -DPATIENCE=1 $two
# shellcheck disable=SC2086
check "a claim that nobody is at work on: all end" holds "$liveness" "-a -f -N all_end" -DPATIENCE=1 -DLOST -DWORKERS=2 $one

check "a claim taken over from a thread of the same process: safety" fails "$safety" "" -DBROKEN_OWN
# shellcheck disable=SC2086
check "a number read before the wait: safety" fails "$safety" "" -DBROKEN_NUMBER -DPATIENCE=1 -DWORKERS=3 $one
# shellcheck disable=SC2086
check "a claim that nobody is at work on, without a new number: liveness" fails "$liveness" "-a -f -N all_end" -DLOST -DWORKERS=2 $one

[ $failures -eq 0 ]
