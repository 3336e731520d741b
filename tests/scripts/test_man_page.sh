#!/usr/bin/env bash
# The man page and `afterglow --help` have the same options with the same arguments; and the page is proper roff.
set -euo pipefail
# shellcheck source=tests/fixtures/shell_test.sh
source "$(dirname "${BASH_SOURCE[0]}")/../fixtures/shell_test.sh"
page=$AFTERGLOW_BUILD_DIR/renderer/afterglow.1

# One line each, as "-o, --outfile FILE". In the page they follow a .TP.
"$AFTERGLOW_PROGRAM" --help | sed -nE 's/^ {2,6}((-., )?--[^ ]+( [^ ]+)?)( {2}.*)?$/\1/p' | sort >"$folder/help"
sed -n '/^\.SH OPTIONS/,/^\.SH EXIT STATUS/p' "$page" | awk 'before == ".TP" { print } { before = $0 }' |
    sed -E 's/\\f.//g; s/\\-/-/g' | sort >"$folder/page"

if [[ $(wc -l <"$folder/help") -lt 10 ]]; then
    echo "FAILED: no options found in --help:"
    cat "$folder/help"
    exit 1
fi
if ! diff -u --label "afterglow --help" "$folder/help" --label "afterglow.1" "$folder/page"; then
    echo "FAILED: the man page and --help differ"
    exit 1
fi
for section in NAME SYNOPSIS DESCRIPTION OPTIONS "EXIT STATUS" ENVIRONMENT FILES EXAMPLES; do
    grep -qx "\.SH $section" "$page" || { echo "FAILED: no section $section"; exit 1; }
done
echo "ok: $(wc -l <"$folder/help") options"

if command -v groff >/dev/null; then
    groff -man -ww -z "$page" 2>"$folder/warnings"
    [[ ! -s $folder/warnings ]] || { echo "FAILED: roff"; cat "$folder/warnings"; exit 1; }
else
    echo "groff is not installed: the page's form was not checked"
fi
