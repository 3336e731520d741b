#!/usr/bin/env bash
# renderer/examples/tiles_slurm.sh makes the picture that one process makes, from one photon map; frames_slurm.sh makes
# frames that share one, and none twice; where each job fills a copy of the map, the last one
# puts the copies together. On a cluster of this machine alone, where it belongs to no other.
set -euo pipefail

# shellcheck source=tests/fixtures/slurm_cluster.sh
source "$(dirname "${BASH_SOURCE[0]}")/../fixtures/slurm_cluster.sh"
slurm_start
# shellcheck source=tests/fixtures/example_tiles.sh
source "$(dirname "${BASH_SOURCE[0]}")/../fixtures/example_tiles.sh"
trap 'slurm_stop; rm -rf "$folder"' EXIT

fail() {
    echo "FAILED: $*"
    cat slurm-*.out
    exit 1
}

expect_tracers() { # how many of the jobs so far traced photons
    [[ $(cat slurm-*.out | grep -c 'photons: .* paths') -eq $1 ]] || fail "not $1 of the jobs traced photons"
    rm -f slurm-*.out
}

expect_one_picture tiles_slurm.sh -v
[[ ! -e tiles.photons ]] || fail "the photon map is left"
expect_tracers 1

# eight jobs fill copies of one map: what is put together has all that the picture asks for
export AFTERGLOW_MAP=$AFTERGLOW_BUILD_DIR/bin/afterglow-map
scene=$root/tests/scenes/box_with_blocks.pbrt
quick=(--size 40x30 --spp 2 --photons 3000 --gather-samples 4)
AFTERGLOW_MAP_COPIES=yes AFTERGLOW=$AFTERGLOW_PROGRAM "$root/renderer/examples/tiles_slurm.sh" "$scene" eight.exr 8 "${quick[@]}" -v
expect_tracers 1
"$AFTERGLOW_PROGRAM" -q "${quick[@]}" --photon-aim 0 -o fresh.exr "$scene"
"$AFTERGLOW_PROGRAM" -q "${quick[@]}" --photon-map eight.photons --stats again.json -o again.exr "$scene"
for picture in eight again; do
    oiiotool --fail 0 --failpercent 0 --hardfail 0 --diff fresh.exr $picture.exr || fail "$picture.exr differs"
done
[[ $(tr -d ' ' <again.json) =~ \"computed\":0, ]] || fail "irradiances were not in the merged map: $(<again.json)"
[[ -z $(find . -name 'eight.p*' ! -name eight.photons) ]] || fail "parts or copies are left: $(ls)"

cp "$root/tests/scenes/block.pbrt" .
for frame in 1 3; do
    sed "s/^LookAt .*/LookAt 0 1 3.$frame  0 1 0  0 1 0/" "$root/tests/scenes/box_with_blocks.pbrt" >shot.000$frame.pbrt
done
quick=(--size 20x16 --spp 1 --photons 3000 --gather-samples 4 --reproducible -v)
render() { # OUT
    AFTERGLOW=$AFTERGLOW_PROGRAM "$root/renderer/examples/frames_slurm.sh" shot.%04d.pbrt "$1" 1-3x2 "${quick[@]}" \
        --photon-map shot.photons
}
render job.%04d.exr
expect_tracers 1
"$AFTERGLOW_PROGRAM" "${quick[@]}" --frames 1,3 -o direct.%04d.exr shot.%04d.pbrt 2>direct.log
for frame in 1 3; do
    oiiotool --fail 0 --failpercent 0 --hardfail 0 --diff direct.000$frame.exr job.000$frame.exr || fail "frame $frame differs"
done
[[ ! -e job.0002.exr ]] || fail "a frame that nobody asked for"
touch -d '2001-01-01' job.0001.exr
rm job.0003.exr
render job.%04d.exr
[[ $(stat -c %Y job.0001.exr) -lt 1000000000 ]] || fail "a frame that was there was rendered again"
[[ -s job.0003.exr ]] || fail "a frame that was missing was not rendered"
