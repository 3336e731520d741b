#!/usr/bin/env bash
# dictionary.sh: the words of the pbrt-v4 format that the reader and the renderer know, for the fuzzers, from their sources.
# Use: tests/fuzz/dictionary.sh >tests/fuzz/pbrt.dict
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/../.."
echo "# made by dictionary.sh"
cat scene/pbrt_*.c scene/parameter_list.c scene/spectra.c scene/color_space.c renderer/render_settings.c |
    grep -v '^#include' | grep -oE '"[A-Za-z][A-Za-z0-9_.-]{0,30}"' | LC_ALL=C sort -u
types=(bool integer float string rgb spectrum texture)
names=(alpha reflectance roughness L I scale radius filename eta displacement)
for type in "${types[@]}"; do
    for name in "${names[@]}"; do
        printf '"\\"%s %s\\""\n' "$type" "$name"
    done
done
