#!/usr/bin/env bash
# The installed tree works by itself, from another folder than it was configured for: program, library, image module,
# headers, man page, pkg-config for users in C and in C++, and find_package.
# ctest: install
set -euo pipefail

# shellcheck source=tests/fixtures/installed_tree.sh
source "$(dirname "${BASH_SOURCE[0]}")/../fixtures/installed_tree.sh"
# shellcheck source=tests/fixtures/python.sh
source "$(dirname "${BASH_SOURCE[0]}")/../fixtures/python.sh"

# Two ways there: another prefix, and a staging folder as packagers use it.
cmake --install "$AFTERGLOW_BUILD_DIR" --prefix "$folder/elsewhere" >install.log || fail "cmake --install: $(<install.log)"
DESTDIR=$folder/staging cmake --install "$AFTERGLOW_BUILD_DIR" >staging.log || fail "DESTDIR: $(<staging.log)"
staged=$(find "$folder/staging" -name afterglow -path '*/bin/*' -printf '%h\n')
mv elsewhere moved # no path of the folder of installation is built in
prefix=$folder/moved

for program in "$prefix/bin/afterglow" "$staged/afterglow"; do
    check_render "$program"
    echo "ok: $(realpath --relative-to="$folder" "$program")"
done

# A picture that could not be written at the end is refused at the beginning: the scene is not even read.
cp -r "$prefix" bare
find bare -name afterglow_image.so -delete
if [[ -e $(sed -nE 's/^CMAKE_INSTALL_PREFIX:PATH=//p' "$AFTERGLOW_BUILD_DIR/CMakeCache.txt")/lib/afterglow/afterglow_image.so ]]; then
    echo "skipped: a module that is missing: there is one where this build would be installed"
else
    status=0
    bare/bin/afterglow -o room.png no-such.pbrt 2>bare.log || status=$?
    [[ $status -ne 0 ]] || fail "rendered without a module"
    grep -q 'image module cannot be opened' bare.log || fail "without a module: $(<bare.log)"
    bare/bin/afterglow -q --photons 1000 -o bare.exr room.pbrt || fail "an EXR file wants no module"
fi

"$prefix/bin/afterglow-map" --version >map_version || fail "afterglow-map does not run"
[[ $(<map_version) == "afterglow-map "* ]] || fail "afterglow-map says: $(<map_version)"
if [[ -x $AFTERGLOW_BUILD_DIR/bin/afterglow-bench ]]; then
    "$prefix/bin/afterglow-bench" --quick -q --threads 2 -o bench.json >bench.log 2>&1 || fail "afterglow-bench: $(<bench.log)"
    [[ -s bench.json && -s $(find "$prefix" -path '*/man/man1/afterglow-bench.1') ]] || fail "no result or man page of afterglow-bench"
    echo "ok: afterglow-bench"
fi

[[ -s $(find "$prefix" -path '*/man/man1/afterglow.1') ]] || fail "no man page"
pc=$(find "$prefix" -name afterglow.pc)
[[ -s $pc ]] || fail "no pkg-config file"
export PKG_CONFIG_PATH=${pc%/*}
[[ "afterglow $(pkg-config --modversion afterglow)" == "$(<version)" ]] || fail "pkg-config knows another version"
read -ra flags <<<"$(pkg-config --cflags --libs afterglow)"
library_folder=$(pkg-config --variable=libdir afterglow)
library=$(readlink -f "$library_folder/libafterglow.so")
soname=$(readelf -d "$library" | sed -nE 's/.*SONAME.*\[(.*)\]/\1/p')
[[ $soname =~ ^libafterglow\.so\.([1-9][0-9]*|0\.[0-9]+)$ && -e $library_folder/$soname ]] || fail "soname is '$soname'"

# The example, as a user in C and as one in C++ compile it.
example=$(find "$prefix" -name render_scene.c)
[[ -s $example ]] || fail "no example"
cp "$example" use.c
cp "$example" use.cpp
warnings=(-Wall -Wextra -Wshadow -Wconversion -pedantic -Werror)
"$CC" -std=c17 "${warnings[@]}" use.c -o use_c "${flags[@]}"
"$CXX" -std=c++17 "${warnings[@]}" use.cpp -o use_cpp "${flags[@]}"
export LD_LIBRARY_PATH=$library_folder
sed 's/\[0.5 0.5 0.5\]/[$rho $rho $rho]/; s/"float fov" 90/&  Integrator "photonmap" "integer indirectphotons" 1000/' room.pbrt >open.pbrt
for user in use_c use_cpp; do
    ./$user open.pbrt $user.png rho=0.5 >said 2>told || fail "$user: $(<told)"
    grep -Eqx "$user.png: 16 x 12, [0-9.]+ [0-9.]+ [0-9.]+ in the middle, [0-9]+ irradiances" said || fail "$user says: $(<said)"
    [[ $(od -An -tx1 -N4 $user.png | tr -d ' ') == 89504e47 ]] || fail "$user wrote no PNG file"
    for phase in load bvh photons map render write; do
        tr '\r' '\n' <told | grep -Ex "$phase +100 %" >/dev/null || fail "$user did not tell the end of $phase: $(<told)"
    done
    echo "ok: $user"
done
cmp use_c.png use_cpp.png || fail "C and C++ give other pictures"

# The Python module, beside the library that was installed.
module=$(find "$prefix" -path '*/lib/python3/dist-packages/afterglow')
for file in "$root"/renderer/python/afterglow/*.* "$AFTERGLOW_BUILD_DIR"/python/afterglow/_declarations.py; do
    cmp "$file" "$module/${file##*/}" || fail "of the Python module there is no ${file##*/}, or another one"
done
if find_python_with_numpy; then
    said=$(AFTERGLOW_LIBRARY=$library PYTHONDONTWRITEBYTECODE=1 PYTHONPATH=${module%/*} "$python" -c 'import afterglow; print(afterglow.version())')
    [[ "afterglow $said" == "$(<version)" ]] || fail "the Python module knows another version: $said"
    echo "ok: Python"
fi

# A scene from memory, three views of it with one photon map.
walk=$(find "$prefix" -name walk.c)
[[ -s $walk ]] || fail "no example of a walk"
"$CC" -std=c17 "${warnings[@]}" "$walk" -o walk "${flags[@]}"
./walk walk.map view >said 2>told || fail "walk: $(<told)"
[[ ! -s told && $(grep -Ec '^view [123]: a first picture after' said) == 3 ]] || fail "walk says: $(<said) $(<told)"
grep -Eqx '[1-9][0-9]* updates of the window' said || fail "the window was never updated: $(<said)"
[[ -s walk.map && -s view3.png ]] && ! cmp -s view1.png view3.png || fail "walk made no two views"
echo "ok: walk"

mkdir cmake_user
cat >cmake_user/CMakeLists.txt <<'END'
cmake_minimum_required(VERSION 3.25)
project(user C)
find_package(afterglow 0.1 REQUIRED)
add_executable(user ../use.c)
target_link_libraries(user PRIVATE afterglow::afterglow)
END
{ cmake -S cmake_user -B cmake_user/build -DCMAKE_C_COMPILER="$CC" -DCMAKE_PREFIX_PATH="$prefix" &&
    cmake --build cmake_user/build; } >cmake.log 2>&1 || fail "find_package: $(<cmake.log)"
cmake_user/build/user open.pbrt use_cmake.png rho=0.5 >said 2>told || fail "found by find_package: $(<told)"
cmp use_c.png use_cmake.png || fail "found by find_package: another picture"
echo "ok: find_package"

./use_c open.pbrt no.png 2>told && fail "a scene with a name left open was rendered"
grep -q 'open.pbrt:.*\$rho has no value' told || fail "of the name it says: $(<told)"
./use_c nothing.pbrt no.png 2>told && fail "a scene that is not there was rendered"
grep -q 'nothing.pbrt: error: ' told || fail "of the scene it says: $(<told)"
# Ctrl-C while it renders.
sed 's/"integer xresolution" 16 "integer yresolution" 12/"integer xresolution" 4096 "integer yresolution" 4096/' room.pbrt >large.pbrt
./use_c large.pbrt no.png 2>told &
user=$!
until tr '\r' '\n' <told | grep '^render' >/dev/null; do
    kill -0 $user 2>/dev/null || fail "it ended: $(<told)"
    sleep 0.05
done
kill -INT $user
wait $user && fail "it was cancelled, and says it succeeded"
tr '\r' '\n' <told | grep -Ex 'cancelled *' >/dev/null || fail "cancelled, it says: $(<told)"
[[ ! -e no.png ]] || fail "it has left a picture"
echo "ok: mistakes and Ctrl-C"
