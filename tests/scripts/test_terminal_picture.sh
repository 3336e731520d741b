#!/usr/bin/env bash
# --progress picture, in a pseudo-terminal: the cells have the colours that a .png file has, with its view and exposure; what
# is drawn anew stands in its place; messages stand above it; signals leave the terminal as it was; where there is no
# terminal there are no codes.
set -euo pipefail
# shellcheck source=tests/fixtures/terminal_test.sh
source "$(dirname "${BASH_SOURCE[0]}")/../fixtures/terminal_test.sh"

python3 -B "$root/tests/fixtures/terminal_picture.py" "$AFTERGLOW_PROGRAM" || fail "the picture in the terminal is wrong"

picture=(--progress picture --integrator path --noise 0 -o a.exr halves.pbrt)
"$AFTERGLOW_PROGRAM" --spp 1 "${picture[@]}" 2>said || fail "into a file: $(<said)"
[[ $(grep -c 'warning: --progress picture: standard error is no terminal' said) -eq 1 ]] || fail "no warning: $(<said)"
! grep -q $'\033' said || fail "codes in a file: $(cat -v said)"
grep -q '^Progress: 100%' said || fail "no progress as usual: $(<said)"
"$AFTERGLOW_PROGRAM" -q --spp 1 "${picture[@]}" 2>said
[[ ! -s said ]] || fail "not quiet: $(<said)"
echo "ok: no terminal"
