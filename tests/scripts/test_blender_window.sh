#!/usr/bin/env bash
# The Blender add-on in a window, on a screen of memory: the 3D view's picture is on the screen, through the display's
# transform, also after the view was orbited and an object moved; F12 renders, and Esc ends it with what there was.
# Skipped where Blender 3.4 (with numpy), Xvfb, xdotool or Mesa is not installed, and in builds with sanitizers.
# ctest: blender
set -euo pipefail
# shellcheck source=tests/fixtures/shell_test.sh
source "$(dirname "${BASH_SOURCE[0]}")/../fixtures/shell_test.sh"
need blender Xvfb xdotool
export LIBGL_ALWAYS_SOFTWARE=1
# shellcheck source=tests/fixtures/blender_test.sh
source "$(dirname "${BASH_SOURCE[0]}")/../fixtures/blender_test.sh"

mkfifo screen
Xvfb -displayfd 7 -screen 0 800x600x24 7>screen 2>xvfb.log &
server=$!
trap 'kill "$server"; rm -rf "$folder"' EXIT
read -r -t 30 number <screen || fail "Xvfb gives no screen: $(<xvfb.log)"
export DISPLAY=:$number

# Blender's exit status says that Esc was pressed.
timeout 500 blender --factory-startup -p 0 0 800 600 -P "$root/tests/fixtures/blender_window.py" -- \
    "$AFTERGLOW_BUILD_DIR/afterglow-blender.zip" "$folder" >blender.log 2>&1 || true
grep '^ok: \|^FAILED: ' blender.log || true
if ! grep -q '^END$' blender.log; then
    ! grep -m 1 'glx\|GLX\|OpenGL' blender.log || skip "there is no OpenGL"
    tail -40 blender.log
    fail "the tests did not come to their end"
fi
! grep '^FAILED: \|^Error: \|Traceback' blender.log >/dev/null || fail "see above"
