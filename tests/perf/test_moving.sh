#!/usr/bin/env bash
# moving.sh's quick form: frames that follow others have the bits of frames alone, and compute anew no more than 1.3
# times what chance alone makes of the photons that came and went. All of it are counts; nothing is timed.
set -euo pipefail
# shellcheck source=tests/fixtures/shell_test.sh
source "$(dirname "${BASH_SOURCE[0]}")/../fixtures/shell_test.sh"
need jq
export AG_BUILD_DIR=$AFTERGLOW_BUILD_DIR AG_PROGRAM=$AFTERGLOW_PROGRAM AG_PERF_BUILD=no
need_benchmark afterglow-picture-error

"$root/perf/scripts/moving.sh" --quick --out "$folder/out" >"$folder/said" || fail "it ended with $?"
awk -F, 'NR == 1 { for (i = 1; i <= NF; i++) at[$i] = i; next }
    { lines++ }
    !($at["c"] > 0 && $at["anew"] > 0 && $at["anew"] < 1 && $at["anew_over_bound"] <= 1.3) { print; bad = 1 }
    END { exit bad || lines != 4 }' "$folder/out/moving.csv" >&2 || fail "moving.csv: $(<"$folder/out/moving.csv")"
echo "ok: $(tail -n 1 "$folder/out/moving.csv")"
