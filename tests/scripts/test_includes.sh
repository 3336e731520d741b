#!/usr/bin/env bash
# An include that a target may not make is refused, in each of the forms that a compiler takes, and one that it may make
# is accepted: tests/includes.cmake with the files and folders of this build, over a copy of the sources in which one
# line is planted.
set -euo pipefail
# shellcheck source=tests/fixtures/shell_test.sh
source "$(dirname "${BASH_SOURCE[0]}")/../fixtures/shell_test.sh"
copy=$folder/sources
mkdir "$copy"
(cd "$root" && find threads scene photonmap renderer -name '*.[ch]' -o -name '*.cpp' | tar -cf - -T -) | tar -xf - -C "$copy"

# check TARGET FILE: the check of that target, of one file of the copy. The words of a message are on one line.
check() {
    local list stamp=$folder/stamp status=0
    list=$(echo "$AFTERGLOW_BUILD_DIR"/*/"$1".includes.files)
    grep -qF -- "$root/$2" "$list" || fail "$2 is no file of $1"
    echo -n "$copy/$2" >"$stamp.files"
    sed "s|$root/|$copy/|g" "${list%.files}.folders" >"$stamp.folders"
    rm -f "$stamp"
    cmake -D TARGET="$1" -D STAMP="$stamp" -D ROOT="$copy" -P "$root/tests/includes.cmake" >"$folder/words" 2>&1 || status=$?
    tr -s ' \n' ' ' <"$folder/words"
    [[ $status != 0 || -f $stamp ]] || fail "$2: no stamp, which the build waits for"
    return "$status"
}

# Puts a line behind the first include of a file of the copy; with_line LINE FILE COMMAND...
with_line() {
    local line=$1 file=$2 status=0
    shift 2
    awk -v "line=$line" '{ print } !done && /^#include/ { print line; done = 1 }' "$root/$file" >"$copy/$file"
    grep -qxF -- "$line" "$copy/$file" || fail "the line was not planted in $file"
    "$@" || status=$?
    cp "$root/$file" "$copy/$file"
    return "$status"
}

refused() { # TARGET FILE LINE TEXT
    with_line "$3" "$2" expect 1 "$4" check "$1" "$2"
    [[ ! -f $folder/stamp ]] || fail "$2: a stamp was written in spite of $3"
    echo "refused: $2: $3"
}

accepted() { # TARGET FILE LINE
    with_line "$3" "$2" check "$1" "$2" || fail "$2: refused: $3"
    echo "accepted: $2: $3"
}

below='scene/readers/scene_file.h, which is not below'
for line in '#include "readers/scene_file.h"' '#include <readers/scene_file.h>' '#include "../readers/scene_file.h"' \
    '#include"readers/scene_file.h"' '#include<scene_file.h>' '  #  include  <readers/scene_file.h> /* [0, 1) */' \
    '#import <readers/scene_file.h>'; do
    refused ag_scene scene/material/coat.c "$line" "$below ag_scene"
done
refused ag_scene scene/material/coat.h '#include <readers/scene_file.h>' "$below ag_scene"
refused ag_photonmap photonmap/photon_map.c '#include <readers/scene_file.h>' "$below ag_photonmap"
refused ag_photonmap photonmap/photon_map.c '#include <film/film.h>' 'renderer/film/film.h, which is not below'
refused ag_image scene/math/transform.c '#include <scene.h>' 'scene/scene.h, which is not below ag_image'
refused ag_scene scene/material/coat.c '#include READER' 'an include by a macro'

# Edges that are cut within a target.
for line in '#include "light/light.h"' '#include <light/light.h>' '#include "../light/light.h"'; do
    refused ag_scene scene/material/coat.c "$line" 'scene/light/light.h: that edge is cut'
done

refused ag_scene scene/texture/image_colors.c '#include <scene.h>' 'scene/scene.h: that edge is cut'
while read -r file header; do
    refused ag_scene "scene/$file" "#include \"$header\"" "scene/$header: that edge is cut"
done <<'END'
texture/texture.c medium/medium.h
shape/shape.c medium/medium.h
medium/medium_flight.c material/fresnel.h
medium/medium_flight.c light/light.h
medium/medium_flight.c scene.h
medium/medium_flight.c rays/bvh.h
material/pane.c medium/medium_flight.h
light/light.c medium/medium.h
light/light.c rays/bvh.h
rays/slab_faces.c texture/texture.h
scene.c rays/embree_api.h
END

refused ag_renderer renderer/render.c '#include <output/output_color.h>' 'output_color.h: that edge is cut'
refused ag_renderer renderer/integrator/eye_pilot.c '#include "context.h"' 'renderer/context.h: that edge is cut'

for line in '#include "math/vec3.h"' '#include <math/vec3.h>' '#include "coat_table.h"' '#include <string.h>' \
    '/* #include "readers/scene_file.h" */'; do
    accepted ag_scene scene/material/coat.c "$line"
done
accepted ag_scene scene/material/pane.c '#include "medium/phase_function.h"'
accepted ag_photonmap photonmap/photon_map.c '#include <scene.h>'
