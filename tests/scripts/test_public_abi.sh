#!/usr/bin/env bash
# The ABI of the library is the one that tests/fixtures/public_abi.txt records: functions, sizes and offsets of public
# structs, values of enums, SONAME. A change of it is meant, or found here.
# To renew the record, after a build: tests/scripts/test_public_abi.sh --renew
set -euo pipefail
here=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)
export AFTERGLOW_BUILD_DIR=${AFTERGLOW_BUILD_DIR:-$here/../../build/release} CC=${CC:-cc}
# shellcheck source=tests/fixtures/shell_test.sh
source "$here/../fixtures/shell_test.sh"
command -v python3 >/dev/null || skip "python3 is not installed"
[[ $(uname -m) == x86_64 ]] || skip "the record is of x86-64"
record=$root/tests/fixtures/public_abi.txt
library=$AFTERGLOW_BUILD_DIR/lib/libafterglow.so
includes=(-I "$root/renderer/include" -I "$root/threads/include")

"$CC" -std=c17 -E -P -x c "${includes[@]}" "$root/renderer/include/afterglow/afterglow.h" |
    python3 "$root/tests/fixtures/public_layout.py" >"$folder/layout.c"
"$CC" -std=c17 "${includes[@]}" "$folder/layout.c" -o "$folder/layout"
{
    readelf --dynamic "$library" | sed -n 's/.*SONAME.*\[\(.*\)\]/soname \1/p'
    nm --dynamic --defined-only --format=posix "$library" | awk '{ print "symbol " $1 }' | LC_ALL=C sort
    "$folder/layout"
} >"$folder/abi"
for what in "soname " "symbol ag_render" "function ag_status ag_render(" "callback void ag_log_fn(" \
    "struct ag_render_settings " "  ag_render_settings.seed at " "enum ag_status" "  AG_PAUSED = "; do
    grep -qF -- "$what" "$folder/abi" || fail "'$what' is not in the list that the headers give"
done
if [[ ${1-} == --renew ]]; then
    cp "$folder/abi" "$record"
    echo "renewed: tests/fixtures/public_abi.txt"
    exit 0
fi
if ! diff -u --label "recorded" "$record" --label "built" "$folder/abi"; then
    fail "the ABI has changed. Where that is meant, a release needs another SONAME; tests/scripts/test_public_abi.sh --renew"
fi
echo "ok: $(wc -l <"$record") lines of ABI"
