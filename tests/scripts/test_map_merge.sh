#!/usr/bin/env bash
# afterglow-map: what a map holds is told, and copies of one map that were filled apart make, in any order, the map that
# one process would have filled: a picture with it computes nothing, and has the bits of a fresh run. Other maps, damage and
# mistakes are told, and write nothing.
set -euo pipefail
# shellcheck source=tests/fixtures/shell_test.sh
source "$(dirname "${BASH_SOURCE[0]}")/../fixtures/shell_test.sh"
need jq
map=$AFTERGLOW_BUILD_DIR/bin/afterglow-map
cd "$folder"
scene=$root/tests/scenes/glass_and_metal.pbrt
render() { # OPTION...
    "$AFTERGLOW_PROGRAM" -q --progress none --photons 4000 --caustic-photons 500 --spp 2 --gather-samples 4 --size 24x24 \
        --type float --reproducible --photon-aim 0 "$@" "$scene"
}
computed() { jq .irradiance.computed "$1"; }

# three copies, filled by the upper, the middle and the lower band
render --photons-only --photon-map empty.map
expect 0 'irradiances: 0 of 4000 computed (0.0 %)' "$map" info empty.map
for line in 'photons: 4000 global, ' 'aimed at: all views alike' 'number of photons: 4000' 'program: ' 'machine: '; do
    grep -qF "$line" said || fail "info says nothing of '$line': $(<said)"
done
for i in 1 2 3; do
    cp empty.map $i.map
    render --photon-map $i.map --tile $i/3 --stats $i.json -o part$i.exr
done
(($(computed 1.json) > 0 && $(computed 2.json) > 0 && $(computed 3.json) > 0)) || fail "a band computed nothing"

# in one order and another, and some of them twice
"$map" merge forth.map 1.map 2.map 3.map >forth || fail "merge ended with $?"
"$map" merge back.map 3.map 3.map empty.map 2.map 1.map 2.map >back || fail "merge ended with $?"
cmp forth back || fail "the order matters: $(cat forth back)"
ready=$(sed -nE 's/irradiances: ([0-9]+) of 4000 .*/\1/p' forth)
((ready > 0)) || fail "merge says: $(<forth)"
"$map" merge back.map back.map forth.map >again
cmp forth again || fail "not idempotent: $(cat forth again)"

# all is there, and the bits are those of a fresh run
render --stats fresh.json -o fresh.exr
[[ $(computed fresh.json) == "$ready" ]] || fail "$ready irradiances are merged, a fresh run computes $(computed fresh.json)"
for name in forth back; do
    render --photon-map $name.map --stats $name.json -o $name.exr
    [[ $(computed $name.json) == 0 ]] || fail "$name.map: $(computed $name.json) irradiances were computed again"
    [[ $(jq .irradiance.ready $name.json) == "$ready" ]] || fail "$name.map: not all are ready"
    cmp fresh.exr $name.exr || fail "$name.map gives another picture"
done
echo "ok: $ready irradiances of three files"

# what OUT holds already is kept
cp 1.map grown.map
"$map" merge grown.map 2.map 3.map >grown || fail "merge ended with $?"
[[ $(sed -nE 's/irradiances: ([0-9]+) of 4000 .*/\1/p' grown) == "$ready" ]] || fail "what was there is lost: $(<grown)"

# another map is refused, and nothing is written
render --seed 7 --photons-only --photon-map other.map
expect 1 'other.map: error: it is another map than 1.map' "$map" merge new.map 1.map other.map
cp other.map kept.map
expect 1 'kept.map: error: it is another map than 1.map' "$map" merge kept.map 1.map
cmp other.map kept.map || fail "another map was replaced"
expect 1 'nowhere.map: error: there is no such file' "$map" merge new.map 1.map nowhere.map
expect 1 'it is no photon map' "$map" info "$scene"
head -c 100000 1.map >cut.map
expect 1 'cut.map: error: it is cut short' "$map" merge new.map 1.map cut.map
[[ ! -e new.map ]] || fail "a map was written all the same"
cp 1.map before.map
expect 1 'another map' "$map" merge 1.map 1.map other.map
cmp 1.map before.map || fail "a map that was to be replaced has changed"
cp "$scene" precious.pbrt
expect 3 'it is not replaced by a photon map' "$map" merge precious.pbrt 1.map 2.map
cmp "$scene" precious.pbrt || fail "a file that is no map was replaced"
expect 3 'no-such-folder' "$map" merge no-such-folder/a.map 1.map

expect 2 'wants info FILE' "$map"
expect 2 'wants info FILE' "$map" merge a.map
expect 2 'wants info FILE' "$map" render a.map
expect 0 'usage: afterglow-map' "$map" --help
expect 0 'afterglow-map ' "$map" --version
if command -v groff >/dev/null; then
    groff -man -ww -z "$AFTERGLOW_BUILD_DIR/renderer/afterglow-map.1" 2>warnings
    [[ ! -s warnings ]] || fail "roff: $(<warnings)"
fi
echo "ok: refusals"
