#!/usr/bin/env bash
# renderer/examples/tiles_slurm.sh makes the picture that one process makes.
set -euo pipefail

command -v sbatch >/dev/null || { echo "SKIPPED: Slurm is not installed"; exit 77; }
timeout 10 sinfo >/dev/null 2>&1 || { echo "SKIPPED: no Slurm cluster answers"; exit 77; }
command -v oiiotool >/dev/null || { echo "SKIPPED: oiiotool is not installed (openimageio-tools)"; exit 77; }
root=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$folder"
scene=$root/tests/scenes/box_with_blocks.pbrt
options=(--size 40x30 --spp 2 --photons 3000 --gather-samples 4)

"$AFTERGLOW_PROGRAM" -q "${options[@]}" -o whole.exr "$scene"
AFTERGLOW=$AFTERGLOW_PROGRAM "$root/renderer/examples/tiles_slurm.sh" "$scene" tiles.exr 3 "${options[@]}"
oiiotool --fail 0 --failpercent 0 --hardfail 0 --diff whole.exr tiles.exr ||
    { echo "FAILED: the tiles are not the picture"; exit 1; }
[[ ! -e tiles.part1.exr ]] || { echo "FAILED: parts are left"; exit 1; }
