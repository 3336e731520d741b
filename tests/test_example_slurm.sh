#!/usr/bin/env bash
# renderer/examples/tiles_slurm.sh makes the picture that one process makes.
set -euo pipefail

command -v sbatch >/dev/null || { echo "SKIPPED: Slurm is not installed"; exit 77; }
timeout 10 sinfo >/dev/null 2>&1 || { echo "SKIPPED: no Slurm cluster answers"; exit 77; }
# shellcheck source=tests/example_tiles.sh
source "$(dirname "${BASH_SOURCE[0]}")/example_tiles.sh"
expect_one_picture tiles_slurm.sh
