#!/usr/bin/env bash
# renderer/gallery/README.md is the page that gallery.sh beside it writes; its pictures are there, small; and the scene
# that it shows renders.
set -euo pipefail
# shellcheck source=tests/fixtures/shell_test.sh
source "$(dirname "${BASH_SOURCE[0]}")/../fixtures/shell_test.sh"
bash "$root/renderer/gallery/gallery.sh" --page >"$folder/page"
if ! diff -u --label renderer/gallery/README.md "$root/renderer/gallery/README.md" --label "gallery.sh --page" "$folder/page"; then
    echo "FAILED: renderer/gallery/README.md is not what renderer/gallery/gallery.sh writes"
    exit 1
fi
sed -nE 's/^!\[.+\]\((.*)\)$/\1/p' "$folder/page" | sort >"$folder/shown"
(cd "$root/renderer/gallery" && find . -name '*.jpg' -printf '%f\n' | sort) >"$folder/there"
[[ $(wc -l <"$folder/shown") -ge 6 ]] || { echo "FAILED: the page shows too little"; exit 1; }
diff -u "$folder/shown" "$folder/there" || { echo "FAILED: other pictures are there than are shown"; exit 1; }
while read -r picture; do
    size=$(stat -c %s "$root/renderer/gallery/$picture")
    ((size < 60000)) || { echo "FAILED: $picture has $size bytes"; exit 1; }
done <"$folder/shown"
echo "ok: $(wc -l <"$folder/shown") pictures"

cd "$folder"
for definition in "" "-Deye=-0.1 1.42 -0.42"; do
    "$AFTERGLOW_PROGRAM" -q ${definition:+"$definition"} --size 24x15 --spp 1 --gather-samples 2 --photons 2000 \
        --caustic-photons 200 -o picture.png "$root/renderer/examples/sunroom.pbrt" 2>said || { cat said; exit 1; }
    [[ -s picture.png && ! -s said ]] || { echo "FAILED: $(<said)"; exit 1; }
done
echo "ok: sunroom.pbrt"
