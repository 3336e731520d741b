#!/usr/bin/env bash
# forty_rooms.sh: builds the renderer, measures the paper's forty rooms, and draws the figures.
# Use: perf/scripts/forty_rooms.sh [--out DIR] [--quick] [other options of afterglow-forty-rooms, see its --help]
# The build goes to $AG_BUILD_DIR (build/release/), the results to DIR (forty_rooms/ in it). Exit code 1 when a check fails.
set -euo pipefail

root=$(cd "$(dirname "${BASH_SOURCE[0]}")/../.." && pwd)
build=${AG_BUILD_DIR:-$root/build/release}
out=$build/forty_rooms
arguments=()
draw=yes
while (($# > 0)); do
    case $1 in
    --out) out=${2:?--out wants a folder}; shift ;;
    --out=*) out=${1#--out=} ;;
    --help) draw=no; arguments+=("$1") ;;
    *) arguments+=("$1") ;;
    esac
    shift
done

cmake -S "$root" -B "$build" -DCMAKE_BUILD_TYPE=Release -DAG_BUILD_PERF=ON >&2
cmake --build "$build" --parallel "$(nproc)" >&2
mkdir -p "$(dirname "$out")"

# Pictures that differ are worth seeing too: the figures are drawn before the verdict is passed on.
status=0
"$build/bin/afterglow-forty-rooms" --out "$out" ${arguments[@]+"${arguments[@]}"} || status=$?
if [[ $draw == yes && $status -le 1 && -s $out/results.csv ]]; then
    if command -v gnuplot >/dev/null; then
        gnuplot -e "folder='$out'" "$root/perf/rooms/forty_rooms.gp"
        printf '%s\n' "$out"/{time,speedup}.{png,svg}
    else
        echo "forty_rooms.sh: no figures: gnuplot is not installed (Debian: gnuplot-nox)" >&2
    fi
fi
exit "$status"
