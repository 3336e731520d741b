# example_tiles.sh: for tests to source, once what they need is there.
# expect_one_picture SCRIPT [OPTION]...: the script of renderer/examples makes the picture that one process makes, and leaves no parts.
command -v oiiotool >/dev/null || { echo "SKIPPED: oiiotool is not installed (openimageio-tools)"; exit 77; }
root=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$folder"

expect_one_picture() {
    local scene=$root/tests/scenes/box_with_blocks.pbrt
    local options=(--size 40x30 --spp 2 --photons 3000 --gather-samples 4)
    "$AFTERGLOW_PROGRAM" -q "${options[@]}" -o whole.exr "$scene"
    AFTERGLOW=$AFTERGLOW_PROGRAM "$root/renderer/examples/$1" "$scene" tiles.exr 3 "${options[@]}" "${@:2}"
    oiiotool --fail 0 --failpercent 0 --hardfail 0 --diff whole.exr tiles.exr ||
        { echo "FAILED: the tiles are not the picture"; exit 1; }
    [[ ! -e tiles.part1.exr ]] || { echo "FAILED: parts are left"; exit 1; }
}
