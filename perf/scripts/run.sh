#!/usr/bin/env bash
# run.sh: the whole benchmark: searches, gather rays and whole frames against Embree's, forty rooms, thread scaling by phase,
# scale, contention, memory, error against time. One page of report, tables by machine, and a verdict.
# Use: perf/scripts/run.sh [--quick] [--repeats N] [--out DIR] [--results DIR] [--parts LIST] [--report-only] [--all-rooms]
# Exit code 1 when a bound of README.md's table is not met or not measured, or a part fails; which one, is named.
set -euo pipefail
# shellcheck source=perf/scripts/suite.sh
. "$(dirname "${BASH_SOURCE[0]}")/suite.sh"

suite_begin run "usage: perf/scripts/run.sh [options]
All benchmarks, one report, judged by the table of perf/README.md. Half an hour; with --quick a minute.
  --parts L      of photon_search, photon_making, gather_rays, frame, forty_rooms, thread_scaling, scale,
                 contention, memory, error_against_time (all; with --quick the last five, and frame)
  --results DIR  where tables, figures and report go (perf/results/MACHINE; with --quick or --parts: report/ in the
                 folder of --out)
  --report-only  measure nothing: report and verdict of what is in the folder of --out
  --all-rooms    all forty rooms (rooms 1, 10, 20, 30, 33, 40)" "$@"
parts=photon_search,photon_making,gather_rays,frame,forty_rooms,thread_scaling,scale,contention,memory,error_against_time
all_parts=$parts
[[ $quick == yes ]] && parts=frame,thread_scaling,scale,contention,memory,error_against_time
rooms=1,10,20,30,33,40 results='' report_only=no is_partial=$quick
while ((${#suite_rest[@]} > 0)); do
    case ${suite_rest[0]} in
    --parts) parts=${suite_rest[1]:?--parts wants a list} is_partial=yes suite_rest=("${suite_rest[@]:1}") ;;
    --results) results=${suite_rest[1]:?--results wants a folder} suite_rest=("${suite_rest[@]:1}") ;;
    --report-only) report_only=yes ;;
    --all-rooms) rooms=1-40 ;;
    *) suite_no_more_options ;;
    esac
    suite_rest=("${suite_rest[@]:1}")
done
for part in ${parts//,/ }; do
    [[ ,$all_parts, == *,$part,* ]] || suite_fail "--parts does not know '$part'"
done
if [[ -z $results ]]; then # the machine's report is of all parts: some of them must not replace it
    results=$suite_root/perf/results/$(suite_machine_name)
    [[ $is_partial == yes ]] && results=$out/report
fi
mkdir -p "$results"
export AG_PERF_BUILD=no # from here on: it is built
options=(--repeats "$repeats")
[[ $quick == yes ]] && options=(--quick)
machine=$(suite_machine)
failures=()

slug() { tr '[:upper:]' '[:lower:]' | sed "s/[^a-z0-9]\{1,\}/_/g; s/^_//; s/_\$//"; }

# Called with ||, which switches errexit off inside: what fails in these functions must return by itself.

# These programs know their own bounds; a line of theirs that misses one is a failure by its name.
run_rows() { # PART: the CSV of a program afterglow-PART, and its own bounds
    local program=$suite_bin/afterglow-${1//_/-} csv=$out/$1/$1.csv
    [[ -x $program ]] || { echo "run: no $program" >&2 && return; } # photon_search wants nanoflann; told as not measured
    "$program" >"$csv" || return 1
    awk -F, '$6 != "" && NR > 1 { print $1 "," ($6 ~ / us$/ ? $2 " us" : $4) "," $6 "," $7 }' "$csv" |
        own_verdicts "$1" >"$out/$1/own_verdicts.csv" || return 1
    [[ -s $out/$1/own_verdicts.csv ]] || { echo "run: $program gave no rows" >&2 && return 1; }
}

own_verdicts() { # PART; lines NAME,VALUE,BOUND,yes|no
    local name value bound holds verdict
    while IFS=, read -r name value bound holds; do
        [[ $holds == yes ]] && verdict=met || verdict=MISSED
        echo "$1.$(slug <<<"$name"),$value,at most,$bound,time,$verdict"
    done
}

run_forty_rooms() {
    local folder=$out/forty_rooms status=0
    local measure=("$suite_bin/afterglow-forty-rooms" --out "$folder" --rooms "$rooms" --modes "on-demand,precompute")
    # where a picture differs there are tables all the same, which tell in how many rooms
    "${measure[@]}" --gathers 1,4,16 --repeats "$repeats" || status=1
    # At 64 the modes are nearly even, and pairs of runs differ by a tenth: medians of a few are noisier than the bound
    # is tight.
    "${measure[@]}" --gathers 64 --repeats "$((repeats < 25 ? 4 * repeats + 1 : 99))" --resume || status=1
    if command -v gnuplot >/dev/null; then # without figures it can still be judged
        gnuplot -e "folder='$folder'" "$suite_root/perf/rooms/forty_rooms.gp" || status=1
    fi
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
    }' "$folder/runs.csv" "$folder/forty_rooms.csv" >"$folder/ratios.csv" || return 1
    return "$status"
}

# The mark is there until a part has ended well, for --report-only to see: a part broken off has failed as well.
for part in ${parts//,/ }; do
    [[ $report_only == no ]] || continue
    echo "run: $part" >&2
    mkdir -p "$out/$part"
    touch "$out/$part/failed"
    rm -f "$out/$part"/*.{csv,json,png,svg} "$out/$part/quick" # an older run's must be neither judged nor shown
    [[ $quick == no ]] || touch "$out/$part/quick"
    has_failed=no
    case $part in
    forty_rooms) run_forty_rooms || has_failed=yes ;;
    photon_search | photon_making | gather_rays) run_rows "$part" || has_failed=yes ;;
    *) "$suite_root/perf/scripts/$part.sh" "${options[@]}" --out "$out/$part" >"$out/$part.txt" || has_failed=yes ;;
    esac
    [[ $has_failed == yes ]] || rm "$out/$part/failed"
done
for part in ${parts//,/ }; do
    [[ ! -e $out/$part/failed ]] || failures+=("$part failed")
    [[ $quick == yes || ! -e $out/$part/quick ]] || suite_fail "$out/$part was measured with --quick: no report of that"
done

# The table of README.md: | `name` | at most or at least | bound | time, wall or count | what it is |
# A bound of a wanted part without a figure, or with one that is no number, is not measured.
echo "name,value,relation,bound,kind,verdict" >"$results/verdicts.csv"
for part in ${parts//,/ }; do cat "$out/$part/ratios.csv" 2>/dev/null || true; done |
    awk -F, -v quick="$quick" -v parts=",$parts," '
    BEGIN { part["scaling"] = "thread_scaling"; part["error"] = "error_against_time" } # others: the first word of a name
    NR == FNR {
        if (split($0, cell, / *\| */) >= 6 && cell[2] ~ /^`.*`$/) {
            name = substr(cell[2], 2, length(cell[2]) - 2)
            relation[name] = cell[3]; bound[name] = cell[4]; kind[name] = cell[5]; order[++bounds] = name
        }
        next
    }
    $1 in told || ($1 in relation && $2 !~ /^[-+]?[.0-9]/) { next }
    {
        told[$1]
        if ($1 == "scaling.machine_share") is_busy = $2 < 0.95
        verdict = "no bound"
        if ($1 in relation) {
            is_met = relation[$1] == "at most" ? $2 <= bound[$1] + 0 : $2 >= bound[$1] + 0
            verdict = quick == "yes" && kind[$1] != "count" ? "not judged" : \
                is_busy && kind[$1] == "wall" ? "not known: the machine is busy" : is_met ? "met" : "MISSED"
        }
        print $1 "," $2 "," relation[$1] "," bound[$1] "," kind[$1] "," verdict
    }
    END {
        for (i = 1; i <= bounds; i++) {
            name = order[i]; word = name; sub(/\..*/, "", word)
            if (!(name in told) && index(parts, "," (word in part ? part[word] : word) ","))
                print name ",," relation[name] "," bound[name] "," kind[name] ",NOT MEASURED"
        }
    }' "$suite_root/perf/README.md" - >>"$results/verdicts.csv"
for part in photon_search photon_making gather_rays; do
    [[ ,$parts, == *,$part,* ]] || continue
    if [[ -s $out/$part/own_verdicts.csv ]]; then
        cat "$out/$part/own_verdicts.csv"
    else
        echo "$part,,,,time,NOT MEASURED"
    fi
done >>"$results/verdicts.csv"
suite_json "$results/verdicts.csv"

not_known=0
while IFS=, read -r name value relation bound kind verdict; do
    case $verdict in
    MISSED) failures+=("$name is $value, wanted $relation $bound") ;;
    "NOT MEASURED") # the quick form leaves out scenes, and what small maps and meshes do not tell
        if [[ $quick == no || ($kind == count && $name != memory.@(peak|triangle)_bytes) ]]; then
            failures+=("$name is not measured${relation:+, wanted $relation $bound}")
        fi
        ;;
    "not known"*) not_known=$((not_known + 1)) ;;
    esac
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
    elif ((not_known > 0)); then
        echo "All bounds that are known are met."
    else
        echo "All bounds are met."
    fi
    ((not_known == 0)) || printf '\nNot known, the machine being busy: %d of the bounds of elapsed time.\n' "$not_known"
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
    section "Memory" memory memory.csv triangles.csv
    section "Error against time" error_against_time equal_error.csv error.csv
} >"$results/report.md"
echo "$results/report.md"
if ((${#failures[@]} > 0)); then
    printf 'run: error: %s\n' "${failures[@]}" >&2
    exit 1
fi
