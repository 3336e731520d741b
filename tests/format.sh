#!/usr/bin/env bash
# format.sh: formats all sources by .clang-format.
# Use: tests/format.sh          formats them in place
#      tests/format.sh --check  names those that are not formatted; exit 1 if there are any
set -euo pipefail

cd "$(dirname "${BASH_SOURCE[0]}")/.."
if ! command -v clang-format >/dev/null; then
    echo "format.sh: clang-format is not installed" >&2
    exit 2
fi

mapfile -d '' sources < <(
    find renderer photonmap scene threads tests perf \( -name '*.c' -o -name '*.h' -o -name '*.cpp' \) -print0 | sort -z)
if [[ ${1-} != --check ]]; then
    clang-format -i "${sources[@]}"
    exit 0
fi
status=0
for source in "${sources[@]}"; do
    if ! clang-format "$source" | cmp -s - "$source"; then
        echo "$source"
        status=1
    fi
done
exit "$status"
