#!/usr/bin/env bash
# Every source is as clang-format of Debian 12 lays it out (the target "format" does it), and no comment's end stands
# alone on a line, or goes on from another comment.
set -euo pipefail
here=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)
cd "$here/../.."
status=0

refuse() { # PATTERN WHY: names the lines of C and C++ sources that match
    if grep -rnE --include='*.[ch]' --include='*.cpp' --include='*.pml' "$1" renderer photonmap scene threads tests perf; then
        echo "$2" >&2
        status=1
    fi
}

refuse '^\s*\*/\s*$' "the end of these comments stands alone on its line: shorten the line before it by a word"
refuse '/\*+ *([Aa]nd|[Bb]ut|[Oo]r|[Ll]ikewise|[Tt]he same)\b' "these comments go on from another: write sentences that stand alone"

if ! command -v clang-format >/dev/null; then
    ((status == 0)) || exit 1
    echo "SKIPPED: clang-format is not installed"
    exit 77
fi
bash "$here/../format.sh" --check || status=1
exit "$status"
