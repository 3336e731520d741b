#!/usr/bin/env bash
# dictionary.sh: the words of a format that its reader knows, for the fuzzers, from its sources.
# Use: tests/fuzz/dictionary.sh pbrt|gltf >tests/fuzz/pbrt.dict|gltf.dict
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/../.."

words() { # FILE...
    cat "$@" | grep -v '^#include' | grep -oE '"[A-Za-z][A-Za-z0-9_.-]{0,50}"' | LC_ALL=C sort -u
}

echo "# made by dictionary.sh"
case ${1-} in
gltf)
    # names stand in quotes
    words scene/readers/gltf/*.c | sed -E 's/^"(.*)"$/"\\"\1\\""/'
    printf '"%s"\n' 'glTF\x02\x00\x00\x00' 'JSON' 'BIN\x00' 'data:image/png;base64,' 'data:;base64,' 5120 5121 5122 5123 5125 \
        5126 33071 33648 10497 null true '{}' '[]' ':{' ':[' ',' 4294967295 '%20' '../'
    ;;
pbrt)
    words scene/readers/pbrt/*.c scene/color/spectra.c scene/color/color_space.c
    for type in bool integer float string rgb spectrum texture; do
        for name in alpha reflectance roughness L I scale radius filename eta displacement; do
            printf '"\\"%s %s\\""\n' "$type" "$name"
        done
    done
    ;;
*)
    sed -n '2,3s/^# \?//p' "${BASH_SOURCE[0]}" >&2
    exit 2
    ;;
esac
