#!/usr/bin/env bash
# --serve: a page in a browser. Who may not ask is refused; the picture, its layers and the file are the same; the file has
# the bits of one that nobody watched; who takes nothing, or sends anything, does no harm.
# ctest: sanitize
set -euo pipefail
# shellcheck source=tests/fixtures/shell_test.sh
source "$(dirname "${BASH_SOURCE[0]}")/../fixtures/shell_test.sh"
need python3
unset OCIO
export SCENE=$root/tests/scenes/box_with_blocks.pbrt

for checks in page_checks.py page_run_checks.py; do
    for check in $(sed -n 's/^def \(\w*\)(program):$/\1/p' "$root/tests/fixtures/$checks"); do
        mkdir "$folder/$check"
        cd "$folder/$check"
        python3 -B "$root/tests/fixtures/$checks" "$AFTERGLOW_PROGRAM" "$check" || fail "$check"
    done
done
