#!/usr/bin/env bash
# run.sh: installs what is missing, builds, and runs the tests.
# Use: tests/run.sh            release (all tests), dev and tsan (those that suit sanitizers), and a build with clang
#      tests/run.sh PRESET...  these alone: release, dev, tsan, release-clang, dev-clang, tsan-clang
#      tests/run.sh --quick    the unit tests in release that are not long: within two minutes on two cores, once built
# It says first what it will do and how long that takes.
# The last line is "N passed, N failed, N skipped"; a build that fails is a failed test. Exit code 1 on any failure.
set -euo pipefail

root=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)
cd "$root"
# shellcheck source=renderer/package/packages.sh
source renderer/package/packages.sh

presets=()
build_only=()
selection=()
targets=(all)
for argument; do
    case $argument in
    --quick) selection=(--label-regex '^unit$' --label-exclude '^long$') targets=(quick_tests) ;;
    release | dev | tsan | release-clang | dev-clang | tsan-clang) presets+=("$argument") ;;
    *)
        sed -n '2,7s/^# \?//p' "${BASH_SOURCE[0]}" >&2
        exit 2
        ;;
    esac
done
if ((${#presets[@]} == 0)); then
    if ((${#selection[@]} > 0)); then
        presets=(release)
    else
        presets=(release dev tsan)
        build_only=(release-clang)
    fi
fi

form=whole
((${#selection[@]} == 0)) || form=quick

# The file with the seconds that the last run of a preset's tests took in this form.
seconds_file() { # PRESET
    echo "build/$1/test_seconds_$form"
}

# Minutes of a preset's tests: as long as its last run in this form, else as measured on two cores of an AMD EPYC that
# had other work, too. The quick form takes about 150 s of processor time there.
test_minutes() { # PRESET
    local seconds usual=25
    case $1 in dev*) usual=5 ;; tsan*) usual=12 ;; esac
    if seconds=$(cat "$(seconds_file "$1")" 2>/dev/null) && [[ $seconds =~ ^[0-9]+$ ]]; then
        echo $((seconds / 60 + 1))
    elif [[ $form == quick ]]; then
        echo $((150 / $(nproc) / 60 + 1))
    else
        echo "$usual"
    fi
}

total=0
for preset in "${presets[@]}" "${build_only[@]}"; do
    minutes=0
    what="build"
    if [[ ! -f build/$preset/build.log ]]; then
        minutes=$((12 / $(nproc) + 1))
        what="build from nothing, $minutes min"
    fi
    if [[ " ${presets[*]} " == *" $preset "* ]]; then
        tests=$(test_minutes "$preset")
        minutes=$((minutes + tests))
        what+="; tests, $tests min"
    fi
    total=$((total + minutes))
    echo "-- $preset: $what"
done
echo "-- $total minutes in all, about"

packages=("${BUILD_PACKAGES[@]}" libcmocka-dev openimageio-tools opencolorio-tools spin clang-format parallel jq file
    libnanoflann-dev lintian)
case " ${presets[*]} ${build_only[*]-} " in *-clang*) packages+=(clang) ;; esac
case " ${presets[*]} " in *" dev-clang "* | *" tsan-clang "*) packages+=(libclang-rt-14-dev) ;; esac
install_packages "${packages[@]}" </dev/null

# The sanitizers of Debian 12 fail at random where a kernel scatters addresses over more bits than they know of.
in_place=()
if setarch --addr-no-randomize true 2>/dev/null; then
    in_place=(setarch --addr-no-randomize)
fi

passed=0
failed=0
skipped=0
notes=()

build() { # PRESET
    echo "== $1: build"
    local log=build/$1/build.log
    mkdir -p "build/$1"
    if { cmake --preset "$1" && cmake --build --preset "$1" --target "${targets[@]}"; } >"$log" 2>&1 </dev/null; then
        return 0
    fi
    cat "$log"
    failed=$((failed + 1))
    notes+=("failed: $1: the build")
    return 1
}

# "STATUS<tab>NAME<tab>REASON" for each test of a JUnit file by ctest, and "part" for each skipped part of a test.
read_results() { # FILE
    awk '
        function attribute(line, name) {
            return match(line, " " name "=\"[^\"]*\"") ? substr(line, RSTART + length(name) + 3, RLENGTH - length(name) - 4) : ""
        }
        function text(line) {
            gsub(/<[^>]*>/, "", line)
            gsub(/&lt;/, "<", line); gsub(/&gt;/, ">", line); gsub(/&quot;/, "\"", line); gsub(/&apos;/, "\x27", line)
            gsub(/&amp;/, "\\&", line)
            return line
        }
        /<testcase / {
            name = attribute($0, "name"); status = attribute($0, "status"); reason = last = message = ""
            count = 0
        }
        /<(skipped|failure|error) / { message = attribute($0, "message") }
        name != "" {
            line = text($0)
            if (line ~ /SKIPPED:/ && reason == "") { reason = line; sub(/.*SKIPPED: */, "", reason) }
            if (line ~ /^\[  SKIPPED \] [a-z_0-9]+$/ && !seen[name, line]++) parts[count++] = substr(line, 14) # said twice
            if (line ~ /[^ \t]/) last = line
        }
        /<\/testcase>/ {
            if (status == "run") status = "passed"
            else if (message ~ /SKIP_RETURN_CODE/) { status = "skipped"; if (reason == "") reason = last }
            else { status = "failed"; reason = message }
            print status "\t" name "\t" reason
            for (i = 0; i < count; i++) print "part\t" name "\t" parts[i]
            name = ""
        }' "$1"
}

run() { # PRESET
    echo "== $1: tests"
    local results=$root/build/$1/results.xml wrapper=() status=0 kind name reason
    case $1 in dev* | tsan*) wrapper=("${in_place[@]}") ;; esac
    local begin=$SECONDS
    rm -f "$results"
    "${wrapper[@]}" ctest --preset "$1" --parallel "$(nproc)" --output-junit "$results" "${selection[@]}" </dev/null ||
        status=$?
    local seconds=$((SECONDS - begin)) count=0 failed_before=$failed
    if [[ -f $results ]]; then
        while IFS=$'\t' read -r kind name reason; do
            case $kind in
            passed) passed=$((passed + 1)) ;;
            failed) failed=$((failed + 1)) ;;
            skipped) skipped=$((skipped + 1)) ;;
            esac
            count=$((count + 1))
            [[ $kind == passed ]] || notes+=("${kind/part/skipped in part}: $1: $name${reason:+: $reason}")
        done < <(read_results "$results")
    fi
    if ((count == 0 || (status != 0 && failed == failed_before))); then
        failed=$((failed + 1))
        notes+=("failed: $1: ctest ended with $status after $count tests")
    else
        echo "$seconds" >"$(seconds_file "$1")"
    fi
}

for preset in "${presets[@]}"; do
    if build "$preset"; then
        run "$preset"
    fi
done
for preset in "${build_only[@]}"; do
    if build "$preset"; then
        passed=$((passed + 1))
    fi
done

if ((${#notes[@]} > 0)); then
    printf '%s\n' "${notes[@]}"
fi
echo "$passed passed, $failed failed, $skipped skipped"
((failed == 0))
