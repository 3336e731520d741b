#!/usr/bin/env bash
# Every test has its row in tests/README.md, by which a reader finds what is held where, and every row has its test.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."
status=0
# the first column of the tables whose head is test_
listed=$(awk -F '|' '/^$/ { is_table = 0 } is_table { print $2 } /^\| `test_` \|/ { is_table = 1 }' README.md |
    grep -o '`[^`]*`' | tr -d '`')
for source in */test_*.c */test_*.sh; do
    name=$(basename "${source%.c}")
    if ! grep -qxF "${name#test_}" <<<"$listed"; then
        echo "$source has no row in tests/README.md" >&2
        status=1
    fi
done
for name in $listed; do
    if ! compgen -G "*/test_${name%.sh}.*" >/dev/null; then
        echo "tests/README.md has a row of $name, which is no test" >&2
        status=1
    fi
done
exit "$status"
