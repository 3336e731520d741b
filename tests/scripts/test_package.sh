#!/usr/bin/env bash
# The Debian package: its fields, its files, and that the program in it runs from wherever it is unpacked. Nothing is
# installed.
# ctest: install
set -euo pipefail

for tool in dpkg-deb dpkg-shlibdeps file cpack; do
    if ! command -v "$tool" >/dev/null; then
        echo "SKIPPED: $tool is not installed"
        exit 77
    fi
done
# shellcheck source=tests/fixtures/installed_tree.sh
source "$(dirname "${BASH_SOURCE[0]}")/../fixtures/installed_tree.sh"

export DEBFULLNAME="Ann Packager" DEBEMAIL=ann@example.org SOURCE_DATE_EPOCH=1700000000
cpack -G DEB --config "$AFTERGLOW_BUILD_DIR/CPackConfig.cmake" -B "$folder/made" >cpack.log 2>&1 ||
    fail "cpack: $(<cpack.log)"
package=$(find made -maxdepth 1 -name '*.deb')
[[ $(basename "$package") =~ ^afterglow_[0-9.]+-1_[a-z0-9]+\.deb$ ]] || fail "no package, or its name is odd: $package"
dpkg-deb -x "$package" tree
check_render "$folder/tree/usr/bin/afterglow"
echo "ok: $(basename "$package") renders"

expect_field() { # NAME VALUE
    local value
    value=$(dpkg-deb -f "$package" "$1")
    [[ $value == "$2" ]] || fail "field $1 is '$value', not '$2'"
}
version=$(<version)
expect_field Package afterglow
expect_field Version "${version#afterglow }-1"
expect_field Architecture "$(dpkg --print-architecture)"
expect_field Section graphics
[[ $(dpkg-deb -f "$package" Description) == *photon* ]] || fail "no description"
expect_field Maintainer "Ann Packager <ann@example.org>"

# Each library that is linked against, also by the module, is a package of this system by name and version.
depends=$(dpkg-deb -f "$package" Depends)
for library in libc6 libembree libopenimageio libopenexr libopencolorio libassimp libjansson zlib1g; do
    [[ $depends == *$library* ]] || fail "it does not depend on $library: $depends"
done
while read -r name relation least; do
    is=$(dpkg-query --show --showformat='${Version}' "$name") || fail "$name is not installed"
    [[ -z $relation ]] || dpkg --compare-versions "$is" ge "$least" || fail "$name $relation $least, but it is $is"
done < <(tr -d '()' <<<"${depends//, /$'\n'}")
echo "ok: depends on $depends"

mapfile -t headers < <(cd "$root" && printf '%s\n' {threads,renderer}/include/afterglow/*.h | sed 's|.*/include/|include/|')
for file in "${headers[@]}" bin/afterglow bin/afterglow-map share/man/man1/afterglow-map.1.gz share/man/man1/afterglow.1.gz \
    share/doc/afterglow/copyright share/doc/afterglow/changelog.gz share/doc/afterglow/changelog.Debian.gz share/doc/afterglow/examples/room.pbrt; do
    [[ -s tree/usr/$file ]] || fail "no $file"
done
[[ -n $(find tree/usr -name afterglow.pc) ]] || fail "no pkg-config file"
zcat tree/usr/share/man/man1/afterglow.1.gz | grep -q '^\.TH AFTERGLOW' || fail "the man page is none"
changelog=$(zcat tree/usr/share/doc/afterglow/changelog.Debian.gz)
[[ $changelog == "afterglow (${version#afterglow }-1) "* ]] || fail "changelog.Debian begins otherwise: $changelog"
[[ $changelog == *" -- Ann Packager <ann@example.org>  Tue, 14 Nov 2023 22:13:20 +0000" ]] || fail "who and when: $changelog"
! grep -rlF "$AFTERGLOW_BUILD_DIR" tree || fail "these name the folder of the build"
if find tree -perm /022 ! -type l | grep .; then
    fail "these may be written by others"
fi
for binary in bin/afterglow lib/libafterglow.so.*.*; do
    ! readelf -S "tree/usr/"$binary | grep -q '\.symtab' || fail "$binary is not stripped"
done
dpkg-deb --ctrl-tarfile "$package" | tar -x --to-stdout ./shlibs | grep -q '^libafterglow 0.1 afterglow' ||
    fail "no shlibs for libafterglow"
dpkg-deb --ctrl-tarfile "$package" | tar -x --to-stdout ./triggers | grep -qx 'activate-noawait ldconfig' ||
    fail "the linker's cache is not renewed"
echo "ok: files"

if command -v lintian >/dev/null; then
    lintian --fail-on error "$package" || fail "lintian"
else
    echo "lintian is not installed: its opinion was not asked"
fi
