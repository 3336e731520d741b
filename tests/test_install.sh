#!/usr/bin/env bash
# The installed tree works by itself, from another place than it was configured for: program, library, image module,
# headers, man page, and pkg-config for users in C and in C++.
# ctest: install
set -euo pipefail

# shellcheck source=tests/installed_tree.sh
source "$(dirname "${BASH_SOURCE[0]}")/installed_tree.sh"

# Two ways there: another prefix, and a staging folder as packagers use it.
cmake --install "$AFTERGLOW_BUILD_DIR" --prefix "$folder/elsewhere" >install.log || fail "cmake --install: $(<install.log)"
DESTDIR=$folder/staging cmake --install "$AFTERGLOW_BUILD_DIR" >staging.log || fail "DESTDIR: $(<staging.log)"
staged=$(find "$folder/staging" -name afterglow -path '*/bin/*' -printf '%h\n')
mv elsewhere moved # no path of the place of installation is built in
prefix=$folder/moved

for program in "$prefix/bin/afterglow" "$staged/afterglow"; do
    check_render "$program"
    echo "ok: $(realpath --relative-to="$folder" "$program")"
done

# What would fail at the end fails at the beginning: here the scene is not even read.
cp -r "$prefix" bare
find bare -name afterglow_image.so -delete
if [[ -e $(sed -nE 's/^CMAKE_INSTALL_PREFIX:PATH=//p' "$AFTERGLOW_BUILD_DIR/CMakeCache.txt")/lib/afterglow/afterglow_image.so ]]; then
    echo "skipped: a module that is missing: there is one where this build would be installed"
else
    status=0
    bare/bin/afterglow -o room.exr no-such.pbrt 2>bare.log || status=$?
    [[ $status -ne 0 ]] || fail "rendered without a module"
    grep -q 'image module cannot be opened' bare.log || fail "without a module: $(<bare.log)"
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
[[ $soname =~ ^libafterglow\.so\.[0-9]+$ && -e $library_folder/$soname ]] || fail "soname is '$soname'"

cat >use.c <<'SOURCE'
#include <afterglow/afterglow.h>

#include <stdio.h>

static void say(void *user, ag_log_level level, const char *message)
{
    (void)user;
    if (level <= AG_LOG_WARNING)
        fprintf(stderr, "%s\n", message);
}

int main(void)
{
    ag_context_settings settings = ag_default_context_settings();
    settings.log = say;
    ag_context *context = NULL;
    ag_scene *scene = NULL;
    ag_film *film = NULL;
    ag_render_settings render;
    ag_status status = ag_context_create(&settings, &context);
    if (status == AG_OK)
        status = ag_scene_load(context, "room.pbrt", &scene);
    if (status == AG_OK)
        status = ag_render_settings_from_scene(context, scene, &render);
    if (status == AG_OK) {
        render.photon_count = 1000;
        status = ag_render(context, scene, &render, &film);
    }
    if (status == AG_OK)
        status = ag_film_write(context, film, NULL, "from_c.exr");
    ag_film_destroy(film);
    ag_scene_destroy(scene);
    ag_context_destroy(context);
    printf("%s %s\n", ag_status_text(status), ag_version());
    return status != AG_OK;
}
SOURCE
cat >use.cpp <<'SOURCE'
#include <afterglow/afterglow.h>

#include <iostream>

int main()
{
    ag_context *context = nullptr;
    const ag_status status = ag_context_create(nullptr, &context);
    std::cout << ag_status_text(status) << ' ' << ag_version() << '\n';
    ag_context_destroy(context);
    return status != AG_OK;
}
SOURCE
"$CC" -std=c17 -Wall -Wextra -pedantic -Werror use.c -o use_c "${flags[@]}"
"$CXX" -std=c++17 -Wall -Wextra -pedantic -Werror use.cpp -o use_cpp "${flags[@]}"
for user in use_c use_cpp; do
    said=$(LD_LIBRARY_PATH=$library_folder ./$user)
    [[ "afterglow ${said#success }" == "$(<version)" ]] || fail "$user says: $said"
    echo "ok: $user"
done
[[ -s from_c.exr ]] || fail "the C program wrote no picture"
