#!/usr/bin/env bash
# run.sh: one fuzz target with libFuzzer, as long as is wished: installs what is missing, builds, starts from the seeds.
# Use: tests/fuzz/run.sh TARGET [SECONDS]     TARGET: pbrt, ply, ...: the fuzz_*.c of this folder; SECONDS: 60
# Inputs that reach new code are kept in build/fuzz/corpus/TARGET, where the next run begins; findings are in
# build/fuzz/findings.
# Exit code 1 where there is one.
set -euo pipefail

root=$(cd "$(dirname "${BASH_SOURCE[0]}")/../.." && pwd)
cd "$root"
# shellcheck source=renderer/package/packages.sh
source renderer/package/packages.sh

target=${1-}
seconds=${2-60}
if (($# < 1 || $# > 2)) || [[ ! -f tests/fuzz/fuzz_$target.c || ! $seconds =~ ^[0-9]+$ ]]; then
    sed -n '2,5s/^# \?//p' "${BASH_SOURCE[0]}" >&2
    exit 2
fi

install_packages "${BUILD_PACKAGES[@]}" clang libclang-rt-14-dev </dev/null
{ cmake --preset fuzz && cmake --build --preset fuzz --target "fuzz_$target"; } </dev/null

bin=$root/build/fuzz/bin/fuzz
corpus=$root/build/fuzz/corpus/$target
findings=$root/build/fuzz/findings
mkdir -p "$corpus" "$findings"
mapfile -t seeds <"$bin/fuzz_$target.seeds"
for seed in "${seeds[@]}"; do
    cp --recursive --update "$seed" "$corpus/"
done

# The sanitizers of Debian 12 fail at random where a kernel scatters addresses over more bits than they know of.
in_place=()
if setarch --addr-no-randomize true 2>/dev/null; then
    in_place=(setarch --addr-no-randomize)
fi
# Beyond malloc_limit_mb an allocation fails instead (fuzz.c), hence 0 here; rss_limit_mb is for what many small ones take.
"${in_place[@]}" nice "$bin/fuzz_$target" -dict="$(<"$bin/fuzz_$target.dictionary")" -artifact_prefix="$findings/$target-" \
    -max_total_time="$seconds" -timeout=120 -report_slow_units=60 -rss_limit_mb=3000 -malloc_limit_mb=0 -max_len=16384 -print_final_stats=1 \
    "$corpus" || exit 1
