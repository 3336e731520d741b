#!/usr/bin/env bash
# compare.sh: two commits side by side in one run: builds both in worktrees, runs them in turn on the same scenes, and
# tells the ratio B / A of each phase's CPU time, of the whole's elapsed time and of the peak memory, with a confidence
# interval: a change that makes a figure worse is seen.
# Use: perf/scripts/compare.sh [--quick] [--repeats N] [--out DIR] [--worse PERCENT] A B
# Writes compare.csv and .json, runs.csv. Exit code 1 when a figure is worse by more than PERCENT (2) with 95 % confidence.
set -euo pipefail
# shellcheck source=perf/scripts/suite.sh
. "$(dirname "${BASH_SOURCE[0]}")/suite.sh"

suite_begin compare "usage: perf/scripts/compare.sh [options] A B
Commits, tags or branches; HEAD~1 HEAD, say. '.' is the working tree as it is.
  --worse P    what counts as worse, percent (2)" "$@"
worse=2
if [[ ${suite_rest[0]:-} == --worse ]]; then
    worse=${suite_rest[1]:?--worse wants a number}
    suite_rest=("${suite_rest[@]:2}")
fi
((${#suite_rest[@]} == 2)) || suite_fail "it wants two commits; see --help"
((repeats >= 3)) || repeats=3

build_of() { # COMMIT: sets program
    local commit folder launcher=()
    if [[ $1 == . ]]; then
        program=$suite_program
        return
    fi
    commit=$(git -C "$suite_root" rev-parse --verify --quiet "$1^{commit}") || suite_fail "'$1' is no commit"
    folder=$suite_build/perf/compare/${commit:0:12}
    program=$folder/build/bin/afterglow
    [[ -x $program ]] && return
    [[ -e $folder/source ]] || {
        git -C "$suite_root" worktree prune
        git -C "$suite_root" worktree add --detach --force "$folder/source" "$commit" >&2
    }
    if command -v ccache >/dev/null; then
        launcher=(-DCMAKE_C_COMPILER_LAUNCHER=ccache -DCMAKE_CXX_COMPILER_LAUNCHER=ccache)
    fi
    CCACHE_BASEDIR=$folder CCACHE_NOHASHDIR=1 cmake -S "$folder/source" -B "$folder/build" -DCMAKE_BUILD_TYPE=Release \
        -DAG_BUILD_PERF=OFF "${launcher[@]}" >&2
    CCACHE_BASEDIR=$folder CCACHE_NOHASHDIR=1 cmake --build "$folder/build" --parallel "$suite_cores" >&2
    git -C "$suite_root" worktree remove --force "$folder/source"
    [[ -x $program ]] || suite_fail "$1 gives no program"
}

build_of "${suite_rest[0]}"
program_a=$program
build_of "${suite_rest[1]}"
program_b=$program

size=(--size 200x200)
[[ $quick == yes ]] && size=(--size 32x32 --photons 20000)
cases=(room-on-demand room-precompute room-path)
[[ $quick == no && -f $suite_scenes/veach-ajar/scene.pbrt ]] && cases+=(veach-ajar)
suite_room 20
run_case() { # NAME BENCH REPEAT
    local arguments
    case $1 in
    room-on-demand) arguments=("$room" --only indirect --gather-samples 16 "${size[@]}") ;;
    room-precompute) arguments=("$room" --only indirect --gather-samples 4 --cache precompute "${size[@]}") ;;
    room-path) arguments=("$room" --integrator path --spp 4 "${size[@]}") ;;
    veach-ajar) arguments=("$suite_scenes/veach-ajar/scene.pbrt" --size 96x54 --spp 4 --photons 100000
        --caustic-photons 10000 --gather-samples 16) ;;
    esac
    suite_run "$1" "$2" "$3" "${arguments[@]}"
}

# The columns of both must be there: what an older program does not tell is left out.
echo "case,differing" >"$out/pixels.csv"
for name in "${cases[@]}"; do
    for ((r = 1; r <= repeats; r++)); do
        order=(A B)
        ((r % 2)) || order=(B A)
        for side in "${order[@]}"; do
            if [[ $side == A ]]; then suite_program=$program_a; else suite_program=$program_b; fi
            run_case "$name" "$side" "$r"
            cp "$suite_work/run.exr" "$suite_work/$side.exr"
        done
    done
    error=$("$suite_bin/afterglow-picture-error" "$suite_work/B.exr" "$suite_work/A.exr")
    echo "$name,${error%%,*}" >>"$out/pixels.csv"
done

# Means of the logarithms of the ratios within a repeat, with Student's t: 95 % of such intervals hold the true ratio.
awk -v worse="$worse" "$suite_awk"'
BEGIN {
    columns = split("photons_cpu_s,map_cpu_s,precompute_cpu_s,render_cpu_s,write_cpu_s,cpu_s,total_s,peak_bytes", column, ",")
    split("12.706,4.303,3.182,2.776,2.571,2.447,2.365,2.306,2.262,2.228,2.201,2.179,2.160,2.145,2.131", student, ",")
}
FILENAME ~ /pixels/ { differing[$1] = $2; next }
{
    if (!($1 in n)) order[++cases] = $1
    if ($3 > n[$1]) n[$1] = $3
    for (i = 1; i <= columns; i++) if ($at[column[i]] != "null") value[$1, column[i], $2, $3] = $at[column[i]]
}
END {
    print "case,figure,a,b,ratio,low,high,verdict,pixels_differing"
    for (k = 1; k <= cases; k++) for (i = 1; i <= columns; i++) {
        c = order[k]; f = column[i]; m = n[c]; sum = square = a = b = count = 0
        for (r = 1; r <= m; r++) {
            x = value[c, f, "A", r]; y = value[c, f, "B", r]
            if (x <= 0 || y <= 0) continue
            count++; l = log(y / x); sum += l; square += l * l; va[count] = x; vb[count] = y
        }
        if (count < 2) continue
        mean = sum / count; deviation = sqrt((square - count * mean * mean > 0 ? square - count * mean * mean : 0) / (count - 1))
        half = (count - 1 <= 15 ? student[count - 1] : 2.1) * deviation / sqrt(count)
        low = exp(mean - half); high = exp(mean + half)
        verdict = low > 1 + worse / 100 ? "WORSE" : high < 1 - worse / 100 ? "better" : "same or not known"
        printf "%s,%s,%.6g,%.6g,%.4f,%.4f,%.4f,%s,%d\n", c, f, median(va, count), median(vb, count), exp(mean), low, high,
            verdict, differing[c]
    }
}' "$out/pixels.csv" "$suite_runs" >"$out/compare.csv"
suite_json "$out/compare.csv"
column -t -s, "$out/compare.csv"
if grep -q ,WORSE, "$out/compare.csv"; then
    suite_fail "worse: $(awk -F, '$8 == "WORSE" { printf "%s%s of %s (%s times)", sep, $2, $1, $5; sep = ", " }' "$out/compare.csv")"
fi
