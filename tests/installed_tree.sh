# installed_tree.sh: whether a tree of installed files renders by itself: for the tests of installing and packaging, which
# source it. They are then in $folder, their own, with a small scene in room.pbrt.
# shellcheck shell=bash

folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
unset AFTERGLOW_MODULE_DIR LD_LIBRARY_PATH OCIO
cd "$folder"

fail() {
    echo "FAILED: $*"
    exit 1
}

cat >room.pbrt <<'SCENE'
Film "rgb" "integer xresolution" 16 "integer yresolution" 12
Sampler "independent" "integer pixelsamples" 1
Camera "perspective" "float fov" 90
WorldBegin
LightSource "point" "point3 from" [0 0.2 0] "rgb I" [1 1 1]
Material "diffuse" "rgb reflectance" [0.5 0.5 0.5]
ReverseOrientation
Shape "sphere" "float radius" 2
SCENE

# check_render PROGRAM: renders with it; leaves what --version says in the file "version".
check_render() {
    "$1" --version >version
    grep -Eqx 'afterglow [0-9]+\.[0-9]+\.[0-9]+' version || fail "--version says: $(<version)"
    # which files are opened: ours from this tree, none from the build
    LD_DEBUG=files LD_DEBUG_OUTPUT=$folder/opened "$1" -q --photons 1000 -o room.exr -o room.png room.pbrt
    cat opened.* >opened && rm opened.*
    [[ $(od -An -tx1 -N4 room.exr | tr -d ' ') == 762f3101 ]] || fail "room.exr is no OpenEXR file"
    [[ $(od -An -tx1 -N4 room.png | tr -d ' ') == 89504e47 ]] || fail "room.png is no PNG file"
    rm room.exr room.png
    local tree
    tree=$(realpath "$(dirname "$1")/..")
    grep -oE '/[^ ]*/(libafterglow\.so|afterglow_image\.so)[.0-9]*' opened | xargs -n1 realpath | sort -u >ours
    [[ $(wc -l <ours) -eq 2 ]] || fail "expected library and module, but these were opened: $(<ours)"
    ! grep -qv "^$tree/" ours || fail "opened from elsewhere: $(<ours)"
}
