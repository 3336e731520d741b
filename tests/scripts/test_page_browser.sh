#!/usr/bin/env bash
# The page of --serve in headless Chromium: the picture, layers, threads and counters are there; a click tells what a pixel is;
# keys and mouse walk; the buttons go back, and stop and keep. SCREENSHOTS=FOLDER leaves there what was seen.
set -euo pipefail
# shellcheck source=tests/fixtures/shell_test.sh
source "$(dirname "${BASH_SOURCE[0]}")/../fixtures/shell_test.sh"
need python3 chromium
cd "$folder"
unset OCIO
export SCENE=$root/tests/scenes/box_with_blocks.pbrt
python3 -B "$root/tests/fixtures/page_browser.py" "$AFTERGLOW_PROGRAM" chromium || fail "the page in Chromium"
