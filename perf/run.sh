#!/usr/bin/env bash
# run.sh: the whole benchmark: searches, gather rays and whole frames against Embree's, forty rooms, thread scaling by phase,
# scale, contention, memory, error against time. One page of report, tables by machine, and a verdict.
# Use: perf/run.sh [--quick] [--repeats N] [--out DIR] [--results DIR] [--parts LIST] [--report-only] [--all-rooms]
# Exit code 1 when a bound of README.md's table is not met, or a part fails; which one, is named.
set -euo pipefail
# shellcheck source=perf/suite.sh
. "$(dirname "${BASH_SOURCE[0]}")/suite.sh"

suite_begin run "usage: perf/run.sh [options]
All benchmarks, one report, judged by the table of perf/README.md. Hours; with --quick minutes.
  --parts L      of photon_search, photon_making, gather_rays, frame, forty_rooms, thread_scaling, scale,
                 contention, memory, error_against_time (all; with --quick the last five, and frame)
  --results DIR  where tables, figures and report go (perf/results/MACHINE; with --quick: report/ in the folder of --out)
  --report-only  measure nothing: report and verdict of what is in the folder of --out
  --all-rooms    all forty rooms (rooms 1, 10, 20, 30, 33, 40)" "$@"
parts=photon_search,photon_making,gather_rays,frame,forty_rooms,thread_scaling,scale,contention,memory,error_against_time
[[ $quick == yes ]] && parts=frame,thread_scaling,scale,contention,memory,error_against_time
rooms=1,10,20,30,33,40 results='' report_only=no
while ((${#suite_rest[@]} > 0)); do
    case ${suite_rest[0]} in
    --parts) parts=${suite_rest[1]:?--parts wants a list} suite_rest=("${suite_rest[@]:1}") ;;
    --results) results=${suite_rest[1]:?--results wants a folder} suite_rest=("${suite_rest[@]:1}") ;;
    --report-only) report_only=yes ;;
    --all-rooms) rooms=1-40 ;;
    *) suite_no_more_options ;;
    esac
    suite_rest=("${suite_rest[@]:1}")
done
if [[ -z $results ]]; then
    results=$suite_root/perf/results/$(suite_machine_name)
    [[ $quick == yes ]] && results=$out/report
fi
mkdir -p "$results"
export AG_PERF_BUILD=no # from here on: it is built
options=(--repeats "$repeats")
[[ $quick == yes ]] && options=(--quick)
machine=$(suite_machine)
failures=()

slug() { tr '[:upper:]' '[:lower:]' | sed "s/[^a-z0-9]\{1,\}/_/g; s/^_//; s/_\$//"; }

# These programs know their own bounds; a line of theirs that misses one is a failure by its name.
run_rows() { # PART: the CSV of a program afterglow-PART, and its own bounds
    mkdir -p "$out/$1"
    local program=$suite_bin/afterglow-${1//_/-}
    [[ -x $program ]] || { echo "run: no $program" >&2 && return; } # photon_search wants nanoflann
    "$program" >"$out/$1/$1.csv"
    awk -F, '$6 != "" && NR > 1 { print $1 "," ($6 ~ / us$/ ? $2 " us" : $4) "," $6 "," $7 }' "$out/$1/$1.csv" | own_verdicts "$1"
}

own_verdicts() { # lines NAME,VALUE,BOUND,yes|no
    while IFS=, read -r name value bound holds; do
        name=$1.$(slug <<<"$name")
        [[ $holds == yes ]] && verdict=met || verdict=MISSED
        echo "$name,$value,at most,$bound,time,$verdict" >>"$out/own_verdicts.csv"
    done
}

run_forty_rooms() {
    local folder=$out/forty_rooms
    local measure=("$suite_bin/afterglow-forty-rooms" --out "$folder" --rooms "$rooms" --modes "on-demand,precompute")
    "${measure[@]}" --gathers 1,4,16 --repeats "$repeats" || return 1
    # At 64 the modes are nearly even: one room's ratio of three repeats is as noisy as the bound is tight.
    "${measure[@]}" --gathers 64 --repeats $((2 * repeats + 1)) --resume || return 1
    ! command -v gnuplot >/dev/null || gnuplot -e "folder='$folder'" "$suite_root/perf/forty_rooms.gp" || return 1
    mv "$folder/results.csv" "$folder/forty_rooms.csv" || return 1
    # Only runs of the same repeat are divided by each other: they met the same machine. A room without a pair counts
    # as 0, which no bound lets pass.
    awk "$suite_awk"'
    FILENAME == ARGV[1] {
        rooms[$at["room"]]; if ($at["repeat"] > last) last = $at["repeat"] + 0
        cpu[$at["mode"], $at["room"], $at["gather"], $at["repeat"]] = $at["cpu_s"]
        next
    }
    { more += $at["computed"] > $at["stored"]; differing += $at["identical"] != 1 }
    END {
        count = split("1 4 16 64", gathers, " ")
        for (i = 1; i <= count; i++) {
            g = gathers[i]; n = 0
            for (r in rooms) {
                k = 0
                for (p = 1; p <= last; p++)
                    if (("precompute", r, g, p) in cpu && ("on-demand", r, g, p) in cpu)
                        ratio[++k] = cpu["precompute", r, g, p] / cpu["on-demand", r, g, p]
                v[++n] = median(ratio, k) + 0
            }
            print "forty_rooms.speedup_" g, median(v, n) # sorts
            if (g != 16) print "forty_rooms.least_" g, (n ? v[1] : "")
        }
        print "forty_rooms.computed_more", more + 0
        print "forty_rooms.differing", differing + 0
    }' "$folder/runs.csv" "$folder/forty_rooms.csv" >"$folder/ratios.csv"
}

[[ $report_only == yes ]] || rm -f "$out/own_verdicts.csv"
for part in ${parts//,/ }; do
    [[ $report_only == no ]] || continue
    echo "run: $part" >&2
    case $part in
    forty_rooms) run_forty_rooms || failures+=("$part failed") ;;
    photon_search | photon_making | gather_rays) run_rows "$part" || failures+=("$part failed") ;;
    frame | thread_scaling | scale | contention | memory | error_against_time)
        "$suite_root/perf/$part.sh" "${options[@]}" --out "$out/$part" >"$out/$part.txt" || failures+=("$part failed")
        ;;
    *) suite_fail "--parts does not know '$part'" ;;
    esac
done

# The table of README.md: | `name` | at most or at least | bound | time or count | what it is |
echo "name,value,relation,bound,kind,verdict" >"$results/verdicts.csv"
for part in ${parts//,/ }; do cat "$out/$part/ratios.csv" 2>/dev/null || true; done |
    awk -F, -v quick="$quick" '
    NR == FNR {
        if (split($0, cell, / *\| */) >= 6 && cell[2] ~ /^`.*`$/) {
            name = substr(cell[2], 2, length(cell[2]) - 2)
            relation[name] = cell[3]; bound[name] = cell[4]; kind[name] = cell[5]
        }
        next
    }
    $1 in told { next }
    {
        told[$1]
        if ($1 == "scaling.machine_share") is_busy = $2 < 0.95
        verdict = "no bound"
        if ($1 in relation) {
            is_met = $2 != "" && (relation[$1] == "at most" ? $2 <= bound[$1] + 0 : $2 >= bound[$1] + 0)
            verdict = quick == "yes" && kind[$1] != "count" ? "not judged" : \
                is_busy && kind[$1] == "wall" ? "not known: the machine is busy" : is_met ? "met" : "MISSED"
        }
        print $1 "," $2 "," relation[$1] "," bound[$1] "," kind[$1] "," verdict
    }' "$suite_root/perf/README.md" - >>"$results/verdicts.csv"
[[ ! -s $out/own_verdicts.csv ]] || cat "$out/own_verdicts.csv" >>"$results/verdicts.csv"
suite_json "$results/verdicts.csv"

while IFS=, read -r name value relation bound _ verdict; do
    [[ $verdict != MISSED ]] || failures+=("$name is $value, wanted $relation $bound")
done < <(tail -n +2 "$results/verdicts.csv")

# --- the report ---

table() { # FILE.csv as markdown
    awk -F, '{ printf "|"; for (i = 1; i <= NF; i++) printf " %s |", $i; print ""
        if (NR == 1) { printf "|"; for (i = 1; i <= NF; i++) printf "---|"; print "" } }' "$1"
}
section() { # TITLE PART TABLE... : tables and figures are copied beside the report
    local title=$1 part=$2 file
    shift 2
    [[ ,$parts, == *,$part,* ]] || return 0
    printf '\n## %s\n' "$title"
    for file in "$@"; do
        [[ -s $out/$part/$file ]] || continue
        cp "$out/$part/$file" "$results/"
        printf '\n'
        if (($(wc -l <"$out/$part/$file") > 100)); then echo "[$file]($file)"; else table "$results/$file"; fi
    done
    for file in "$out/$part"/*."$([[ $quick == yes ]] && echo svg || echo png)"; do
        [[ -s $file ]] || continue
        cp "$file" "$results/$part-${file##*/}"
        printf '\n![%s](%s)\n' "$title" "$part-${file##*/}"
    done
}
{
    echo "# Afterglow: what it costs on this machine"
    printf '\n%s\n\n' "$machine"
    echo "Medians of interleaved runs. On a machine that does other work too, elapsed seconds mean little;"
    echo "ratios within a run, CPU time and counts mean what they say. What each figure is: perf/README.md."
    printf '\n## Verdict\n\n'
    if ((${#failures[@]} > 0)); then
        printf -- '- **%s**\n' "${failures[@]}"
    elif [[ $quick == yes ]]; then
        echo "Counts and ratios of work are as they should be; time was not judged."
    else
        echo "All bounds are met."
    fi
    printf '\n'
    table "$results/verdicts.csv"
    section "Photon map against nanoflann" photon_search photon_search.csv
    section "Making the photon map" photon_making photon_making.csv
    section "Gather rays against Embree's" gather_rays gather_rays.csv
    section "A whole frame against Embree's rays" frame frame.csv
    section "Forty rooms" forty_rooms forty_rooms.csv
    section "Threads, by phase" thread_scaling scaling.csv waiting.csv arithmetic.csv
    section "Growth" scale exponents.csv scale.csv
    section "Contention" contention contention.csv
    section "Memory" memory memory.csv
    section "Error against time" error_against_time equal_error.csv error.csv
} >"$results/report.md"
echo "$results/report.md"
if ((${#failures[@]} > 0)); then
    printf 'run: error: %s\n' "${failures[@]}" >&2
    exit 1
fi
