#!/usr/bin/env bash
# renderer/examples/tiles_parallel.sh makes the picture that one process makes.
set -euo pipefail

command -v parallel >/dev/null || { echo "SKIPPED: GNU parallel is not installed"; exit 77; }
parallel --version 2>/dev/null | grep GNU >/dev/null || { echo "SKIPPED: this parallel is not GNU's"; exit 77; }
# shellcheck source=tests/fixtures/example_tiles.sh
source "$(dirname "${BASH_SOURCE[0]}")/../fixtures/example_tiles.sh"
expect_one_picture tiles_parallel.sh
