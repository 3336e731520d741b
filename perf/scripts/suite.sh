# shellcheck shell=bash
# shellcheck disable=SC2034 # what is set here is used by those who source this
# suite.sh: what the benchmark scripts share: options, the build, one run of the renderer as a line of CSV, and tables.
# To be sourced. Each script writes into its folder: runs.csv (every run), its tables, and ratios.csv ("name,value"),
# which run.sh holds against the table of README.md.

export LC_ALL=C
suite_root=$(cd "$(dirname "${BASH_SOURCE[0]}")/../.." && pwd)
suite_build=${AG_BUILD_DIR:-$suite_root/build/release}
suite_bin=$suite_build/bin
suite_program=${AG_PROGRAM:-$suite_bin/afterglow}
suite_scenes=${AG_SCENES:-$suite_root/../shared/scenes}
suite_cores=$(nproc)

suite_fail() {
    echo "$suite_name: error: $*" >&2
    exit 1
}

# suite_begin NAME TEXT ARGUMENTS...: the options all scripts have: sets quick, repeats, out; what is left: suite_rest.
suite_begin() {
    suite_name=$1
    local text=$2
    shift 2
    quick=no repeats=5 out='' suite_rest=()
    while (($# > 0)); do
        case $1 in
        --quick) quick=yes repeats=1 ;;
        --repeats) repeats=${2:?--repeats wants a number} && shift ;;
        --out) out=${2:?--out wants a folder} && shift ;;
        --help)
            printf '%s\n' "$text" "  --quick      small sizes, one run of each: counts and ratios of work, not time" \
                "  --repeats N  interleaved runs of each (5); medians are told" \
                "  --out DIR    where to write (perf/ in the build folder, \$AG_BUILD_DIR)"
            exit 0
            ;;
        *) suite_rest+=("$1") ;;
        esac
        shift
    done
    [[ $repeats =~ ^[1-9][0-9]*$ ]] || suite_fail "--repeats wants a number, not '$repeats'"
    out=${out:-$suite_build/perf/$suite_name}
    mkdir -p "$out"
    out=$(cd "$out" && pwd)
    mkdir -p "$suite_build/perf"
    suite_work=$(mktemp -d "$suite_build/perf/$suite_name.XXXXXX") # its own: two runs may go on at once
    trap 'rm -rf "$suite_work"' EXIT
    suite_runs=$out/runs.csv
    rm -f "$suite_runs" "$out/ratios.csv"
    if [[ ${AG_PERF_BUILD:-yes} == yes ]]; then
        cmake -S "$suite_root" -B "$suite_build" -DCMAKE_BUILD_TYPE=Release -DAG_BUILD_PERF=ON >&2
        cmake --build "$suite_build" --parallel "$suite_cores" >&2
    fi
    [[ -x $suite_program ]] || suite_fail "$suite_program is not there"
}

suite_no_more_options() { ((${#suite_rest[@]} == 0)) || suite_fail "unknown option '${suite_rest[0]}'; see --help"; }

suite_room() { # NUMBER: writes a room of the forty, once; sets room
    room=$suite_work/room-$(printf %02d "$1").pbrt
    "$suite_bin/afterglow-rooms" --out "$suite_work" --first "$1" --last "$1" >/dev/null
}

suite_columns=(.threads .time_s.total .cpu_s
    .time_s.{load,bvh,photons,map,precompute,render,write} .phase_cpu_s.{load,bvh,photons,map,precompute,render,write}
    .memory.peak_bytes .photons.{bytes,stored_global,emitted}
    .irradiance.{requests,computed,distinct,deferred,waited,wait_s,duplicated,uncached} .rays.{camera,gather,photon,path})

# suite_run BENCH VARIANT REPEAT ARGUMENTS...: one run; a line in runs.csv; its picture is $suite_work/run.exr.
# startup_s is all that is outside of the program's own clock: starting and ending the process.
suite_run() {
    local bench=$1 variant=$2 repeat=$3 begin end names
    shift 3
    if [[ ! -s $suite_runs ]]; then
        names=$(printf '%s,' "${suite_columns[@]}" |
            sed 's/\.time_s\.\([a-z]*\)/\1_s/g; s/\.phase_cpu_s\.\([a-z]*\)/\1_cpu_s/g; s/\.[a-z]*\././g; s/\.//g; s/,$//
                s/,camera,gather,photon,path/,camera_rays,gather_rays,photon_rays,path_rays/')
        echo "bench,variant,repeat,wall_s,startup_s,$names" >"$suite_runs"
    fi
    rm -f "$suite_work/run.exr" "$suite_work/run.json"
    begin=$EPOCHREALTIME
    "$suite_program" -q --progress none --noise 0 --reproducible -o "$suite_work/run.exr" --stats "$suite_work/run.json" "$@" ||
        suite_fail "$suite_program failed: $*"
    end=$EPOCHREALTIME
    names=$(printf '%s, ' "${suite_columns[@]}")
    # shellcheck disable=SC2016 # jq's own $
    jq -r --arg bench "$bench" --arg variant "$variant" --arg repeat "$repeat" --arg from "$begin" --arg to "$end" \
        '(($to | tonumber) - ($from | tonumber)) as $wall |
        [$bench, $variant, $repeat, $wall, $wall - .time_s.total, '"${names%, }"'] | map(tostring) | join(",")' \
        "$suite_work/run.json" >>"$suite_runs"
}

suite_ratio() { echo "$1,$2" >>"$out/ratios.csv"; } # NAME VALUE: a figure for run.sh to judge

suite_json() { # FILE.csv: the same as FILE.json, an array of objects
    jq -R -s 'split("\n") | map(select(length > 0) | split(",")) | .[0] as $names | .[1:] |
        map([$names, map(tonumber? // .)] | transpose | map({key: .[0], value: .[1]}) | from_entries)' \
        "$1" >"${1%.csv}.json"
}

# For awk programs over CSV with a heading: at["name"] is a column; median(values, count) sorts its values.
# shellcheck disable=SC2034,SC2016 # used by those who source this; awk's own $
suite_awk='
function median(v, n,    i, j, x) {
    for (i = 2; i <= n; i++) {
        x = v[i]
        for (j = i - 1; j >= 1 && v[j] > x; j--) v[j + 1] = v[j]
        v[j + 1] = x
    }
    return n == 0 ? "" : n % 2 ? v[(n + 1) / 2] : (v[n / 2] + v[n / 2 + 1]) / 2
}
BEGIN { FS = OFS = "," }
FNR == 1 { for (i = 1; i <= NF; i++) at[$i] = i; next }
'

suite_plot() { # gnuplot's text on standard input; FILE without its ending: a PNG and an SVG
    local text
    text=$(cat)
    if ! command -v gnuplot >/dev/null; then
        echo "$suite_name: no figures: gnuplot is not installed (Debian: gnuplot-nox)" >&2
        return
    fi
    local formats=(png svg)
    [[ $quick == yes ]] && formats=(svg)
    for format in "${formats[@]}"; do
        {
            if [[ $format == png ]]; then
                echo "set terminal pngcairo noenhanced size 1100,700 font 'DejaVu Sans,12' background rgb 'white'"
            else
                echo "set terminal svg noenhanced size 1100,700 font 'DejaVu Sans,Arial,sans-serif,12' background 'white'"
            fi
            echo "set output '$1.$format'; set datafile separator ','; set grid lc rgb '#dddddd'; set border lc rgb '#555555'"
            echo "$text"
        } | gnuplot
    done
}

suite_machine() { # what is measured, and where, as markdown
    local model memory
    model=$(sed -n 's/^model name[[:space:]]*: //p' /proc/cpuinfo | head -n 1)
    memory=$(awk '/^MemTotal/ { printf "%.0f", $2 / 1048576 }' /proc/meminfo)
    echo "| | |"
    echo "|---|---|"
    echo "| CPU | ${model:-unknown}, $suite_cores usable of $(getconf _NPROCESSORS_ONLN) |"
    echo "| memory | $memory GiB |"
    # shellcheck disable=SC1091
    echo "| system | $(. /etc/os-release && echo "$PRETTY_NAME"), Linux $(uname -r | cut -d- -f1) |"
    echo "| compiler | $("${CC:-cc}" --version | head -n 1) |"
    echo "| program | $("$suite_program" --version), $(git -C "$suite_root" describe --always --dirty 2>/dev/null || echo 'no git') |"
    echo "| when | $(date -u +%F), load average $(cut -d' ' -f1 /proc/loadavg) at the beginning |"
}

suite_machine_name() { # for a folder: xeon-2-cores
    local model
    model=$(sed -n 's/^model name[[:space:]]*: //p' /proc/cpuinfo | head -n 1)
    echo "${model:-unknown} $suite_cores cores" | sed 's/([A-Za-z]*)//g; s/ CPU//; s/@//; s/Processor//' |
        tr '[:upper:] ' '[:lower:]-' | sed 's/--*/-/g; s/[^a-z0-9.-]//g'
}
