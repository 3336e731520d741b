#!/usr/bin/env bash
# --progress picture in pseudo-terminals that have sixels: decoded, the pixels are those of the .png file, as near as the
# terminal's number of colours allows; one picture in its place; terminals that have none, are silent or late have half
# blocks; no answer, and no other mode of the terminal, is left behind.
set -euo pipefail
# shellcheck source=tests/fixtures/terminal_test.sh
source "$(dirname "${BASH_SOURCE[0]}")/../fixtures/terminal_test.sh"

cat >balls.pbrt <<'END'
Film "rgb" "integer xresolution" 32 "integer yresolution" 15
LookAt 0 0 0  0 0 1  0 1 0
Camera "perspective" "float fov" 60
WorldBegin
LightSource "point" "point3 from" [-3 4 -2] "rgb I" [40 40 40]
LightSource "infinite" "rgb L" [.2 .3 .5]
AttributeBegin
Translate -1.2 0 4
Material "diffuse" "rgb reflectance" [.8 .2 .1]
Shape "sphere"
AttributeEnd
AttributeBegin
Translate 1.2 0 4
Material "diffuse" "rgb reflectance" [.2 .7 .3]
Shape "sphere"
AttributeEnd
END
python3 -B "$root/tests/fixtures/terminal_sixels.py" "$AFTERGLOW_PROGRAM" || fail "the picture in the terminal is wrong"
