#!/usr/bin/env bash
# Every source is as clang-format of Debian 12 lays it out (the target "format" does it).
set -euo pipefail
if ! command -v clang-format >/dev/null; then
    echo "SKIPPED: clang-format is not installed"
    exit 77
fi
exec bash "$(dirname "${BASH_SOURCE[0]}")/../format.sh" --check
