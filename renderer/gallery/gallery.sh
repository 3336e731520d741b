#!/usr/bin/env bash
# gallery.sh: renders the pictures of renderer/gallery/README.md, and writes that page: the commands on it are those that run here.
# Use: renderer/gallery/gallery.sh          renders all, seven minutes of CPU; wants oiiotool for what is put together
#      renderer/gallery/gallery.sh --page   prints the page and renders nothing
set -euo pipefail

root=$(cd "$(dirname "${BASH_SOURCE[0]}")/../.." && pwd)
bin=$root/build/release/bin
pictures=$root/renderer/gallery

say() { printf '%s\n' "$@" >>"$page"; }

# run PROGRAM ARGUMENT...: a line of the page, in a block of code; and what it says is done, in a folder for the work.
run() {
    local line='' argument
    for argument; do
        if [[ $argument =~ [^-A-Za-z0-9_./,:=+] ]]; then
            argument="'$argument'"
        fi
        line+="${line:+ }$argument"
    done
    say "    ${line//$root\//}"
    [[ -z $work ]] || (cd "$work" && PATH=$bin:$PATH "$@")
}

# show NAME WHAT: NAME.png, as JPEG.
show() {
    if [[ -n $work ]]; then
        mkdir -p "$pictures"
        # without the history that oiiotool writes: it names folders of the machine
        oiiotool "$work/$1.png" -d uint8 --compression jpeg:85 --nosoftwareattrib \
            --eraseattrib "Software|Exif:ImageHistory" -o "$pictures/$1.jpg"
    fi
    say "" "![$2]($1.jpg)" ""
}

if [[ ${1-} == --page ]]; then
    work=''
    page=/dev/stdout
else
    work=$(mktemp -d)
    trap 'rm -rf "$work"' EXIT
    page=$work/gallery.md
fi

sunroom=$root/renderer/examples/sunroom.pbrt
size=(--size 480x300)
say "# Gallery" "" \
    "Made by \`renderer/gallery/gallery.sh\`, which runs the commands below: what they say is what was done. The PNG files" \
    "are shown as JPEG. They are for the folder of the sources, with \`build/release/bin\` in \`\$PATH\`; \`afterglow-rooms\` is" \
    "built there, and not installed." ""

say "## Bounced light" "" \
    "The sun shines through a window, and what is not in its patch of light is lit by what that patch and the sky send on." \
    "Seen through ACES 1.0, the first view of the config built in. The photon map is kept for the pictures that follow." ""
run afterglow -q "${size[@]}" --spp 32 --caustic-photons 2e6 --photon-map sunroom.map \
    --aov light,albedo,N,Z,lightgroups,irradiance,photon_density,cache_state,crypto_material \
    --exposure 0.4 -o sunroom.exr -o sunroom.png "$sunroom"
show sunroom "A room with a window to the left, the sun's light on table, floor and a striped rug"
say "Its parts, which are layers of \`sunroom.exr\`: direct light, indirect light (one stop brighter), and what mirrors and" \
    "glass show:" ""
run oiiotool -i:ch=direct.R,direct.G,direct.B sunroom.exr --chnames R,G,B --powc 0.4545 \
    -i:ch=indirect.R,indirect.G,indirect.B sunroom.exr --chnames R,G,B --mulc 2 --powc 0.4545 \
    -i:ch=specular.R,specular.G,specular.B sunroom.exr --chnames R,G,B --powc 0.4545 \
    --mosaic:pad=6 3x1 --resize 960x0 -d uint8 -o parts.png
show parts "Three pictures side by side: the sun's patches alone; an evenly lit room without them; reflections on the floor, glass and copper"

say "## A caustic" "" \
    "The same map, another point to look from: light that a glass, a glass ball and a copper ball throw on the table." \
    "The scene leaves that point open (\`\${eye:-…}\`), \`-D\` fills it in." ""
run afterglow -q "${size[@]}" --spp 32 --caustic-photons 2e6 --photon-map sunroom.map \
    -D 'eye=-0.1 1.42 -0.42' -D 'at=-0.66 0.76 0.40' -D fov=36 --exposure 0.2 -o caustic.png "$sunroom"
show caustic "A table in the sun: a tumbler with bright curves in its shadow, a glass ball that focuses the light beside it, a copper ball"

say "## Layers" "" "Albedo, normals, and depth, as \`--aov\` asks for them:" ""
run oiiotool -i:ch=albedo.R,albedo.G,albedo.B sunroom.exr --chnames R,G,B --powc 0.4545 \
    -i:ch=N.X,N.Y,N.Z sunroom.exr --chnames R,G,B --mulc 0.5 --addc 0.5 \
    -i:ch=Z,Z,Z sunroom.exr --chnames R,G,B --mulc -0.14 --addc 1 --clamp:min=0:max=1 \
    --mosaic:pad=6 3x1 --resize 960x0 -d uint8 -o layers.png
show layers "Flat colours; normals as colours; depth from light to dark"
say "Light groups, each a name at a light in the scene: the sun, the sky (two stops brighter), and the lamp in the corner" \
    "(four stops):" ""
run oiiotool -i:ch=light_sun.R,light_sun.G,light_sun.B sunroom.exr --chnames R,G,B --powc 0.4545 \
    -i:ch=light_sky.R,light_sky.G,light_sky.B sunroom.exr --chnames R,G,B --mulc 4 --powc 0.4545 \
    -i:ch=light_lamp.R,light_lamp.G,light_lamp.B sunroom.exr --chnames R,G,B --mulc 16 --powc 0.4545 \
    --mosaic:pad=6 3x1 --resize 960x0 -d uint8 -o groups.png
show groups "The sun's direct light; the blue light of the sky near the window; a warm glow around the lamp"

say "## How the photon map fares" "" \
    "Irradiance as the map gives it at the first surface; photons per area; and of the photon that is nearest, whether its" \
    "irradiance was demanded (white) or not (grey) while the picture was made:" ""
run oiiotool -i:ch=irradiance.R,irradiance.G,irradiance.B sunroom.exr --chnames R,G,B --mulc 0.15 --powc 0.4545 \
    -i:ch=photon_density.V,photon_density.V,photon_density.V sunroom.exr --chnames R,G,B --mulc 0.00003 --powc 0.4545 \
    -i:ch=cache_state.V,cache_state.V,cache_state.V sunroom.exr --chnames R,G,B --mulc 0.5 --powc 2.2 \
    --mosaic:pad=6 3x1 --resize 960x0 -d uint8 -o map.png
show map "A smooth map of irradiance; dense photons where the sun shines; nearly all photons' irradiance demanded"

say "## Coloured walls, glass and gold" "" "The first scene, as \`renderer/quickstart.sh\` renders it, smaller:" ""
run afterglow -q --size 480x360 --spp 32 -o room.png "$root/renderer/examples/room.pbrt"
show room "A room with walls of terracotta and teal, a glass ball with its caustic, a gold ball on a plinth"

say "## One of the forty rooms" "" \
    "Room 20 of the suite that [the paper's experiment](../../perf/rooms/forty_rooms.md) was repeated with:" ""
run afterglow-rooms --out rooms --first 20 --last 20
run afterglow -q --size 480x480 --spp 16 --gather-samples 16 -o forty_rooms.png rooms/room-20.pbrt
show forty_rooms "A room with a red and a green wall, full of grey spheres that take on their colours"

[[ -z $work ]] || mv "$page" "$root/renderer/gallery/README.md"
