#!/usr/bin/env bash
# quickstart.sh: from a fresh Debian to a first picture: installs what is missing, builds, renders an example.
# Writes below build/ alone. May be called again, and from anywhere.
set -euo pipefail

root=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)
build=$root/build/release
# shellcheck source=renderer/package/packages.sh
source "$root/renderer/package/packages.sh"
install_packages "${BUILD_PACKAGES[@]}"

cd "$root"
echo "Building in $build"
mkdir -p "$build"
# Another compiler's new warnings shall not stop anybody from seeing a picture.
if ! { cmake --preset release -DAG_BUILD_TESTS=OFF -DAG_WERROR=OFF && cmake --build --preset release; } >"$build/quickstart.log" 2>&1; then
    cat "$build/quickstart.log" >&2
    exit 1
fi

echo "Rendering renderer/examples/room.pbrt"
"$build/bin/afterglow" --outfile "$build/room.exr" --outfile "$build/room.png" renderer/examples/room.pbrt
echo "Here is the picture:"
echo "  $build/room.exr  (scene-linear)"
echo "  $build/room.png  (to look at)"
