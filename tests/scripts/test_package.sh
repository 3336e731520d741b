#!/usr/bin/env bash
# The Debian packages: their fields, their files, and that the program and the Python module in them run from wherever they
# are unpacked. Nothing is installed.
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
# shellcheck source=tests/fixtures/python.sh
source "$(dirname "${BASH_SOURCE[0]}")/../fixtures/python.sh"

# The maintainer may be named in one variable or in two.
echo "include($(dirname "${BASH_SOURCE[0]}")/../../renderer/package/package_maintainer.cmake)
message(\"\${CPACK_PACKAGE_CONTACT}\")" >maintainer.cmake
expect_maintainer() { # NAME MAIL EXPECTED
    local is
    is=$(DEBFULLNAME=$1 DEBEMAIL=$2 cmake -P maintainer.cmake 2>&1)
    [[ $is == "$3" ]] || fail "DEBFULLNAME '$1' and DEBEMAIL '$2' give '$is', not '$3'"
}
expect_maintainer "" "Ann Packager <ann@example.org>" "Ann Packager <ann@example.org>"
expect_maintainer "Bea Builder" "Ann Packager <ann@example.org>" "Bea Builder <ann@example.org>"
expect_maintainer "" "<ann@example.org>" "The Afterglow authors <ann@example.org>"
expect_maintainer "Bea Builder" bea@example.org "Bea Builder <bea@example.org>"

export DEBFULLNAME="Ann Packager" DEBEMAIL=ann@example.org SOURCE_DATE_EPOCH=1700000000
cpack -G DEB --config "$AFTERGLOW_BUILD_DIR/CPackConfig.cmake" -B "$folder/made" >cpack.log 2>&1 ||
    fail "cpack: $(<cpack.log)"
[[ $(find made -maxdepth 1 -name '*.deb' | wc -l) -eq 2 ]] || fail "there are not two packages: $(ls made)"
package=$(find made -maxdepth 1 -name 'afterglow_*.deb')
python_package=$(find made -maxdepth 1 -name 'python3-afterglow_*_all.deb')
[[ -n $python_package ]] || fail "no package of the Python module: $(ls made)"
[[ $(basename "$package") =~ ^afterglow_[0-9.]+-1_[a-z0-9]+\.deb$ ]] || fail "no package, or its name is odd: $package"
dpkg-deb -x "$package" tree
check_render "$folder/tree/usr/bin/afterglow"
echo "ok: $(basename "$package") renders"

expect_field() { # PACKAGE NAME VALUE
    local value
    value=$(dpkg-deb -f "$1" "$2")
    [[ $value == "$3" ]] || fail "$(basename "$1"): field $2 is '$value', not '$3'"
}
version=$(<version)
version=${version#afterglow }
expect_field "$package" Package afterglow
expect_field "$package" Architecture "$(dpkg --print-architecture)"
expect_field "$package" Section graphics
expect_field "$python_package" Package python3-afterglow
expect_field "$python_package" Architecture all
expect_field "$python_package" Section python
expect_field "$python_package" Depends "python3 (>= 3.9), python3-numpy, afterglow (= $version-1)"
for each in "$package" "$python_package"; do
    expect_field "$each" Version "$version-1"
    expect_field "$each" Maintainer "Ann Packager <ann@example.org>"
    [[ $(dpkg-deb -f "$each" Description) == *photon* ]] || fail "$each: no description"
done

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
    share/doc/afterglow/examples/room.pbrt; do
    [[ -s tree/usr/$file ]] || fail "no $file"
done
[[ -n $(find tree/usr -name afterglow.pc) ]] || fail "no pkg-config file"
zcat tree/usr/share/man/man1/afterglow.1.gz | grep '^\.TH AFTERGLOW' >/dev/null || fail "the man page is none"
[[ ! -e tree/usr/lib/python3 ]] || fail "the Python module is in both packages"
dpkg-deb -x "$python_package" tree # beside the other, as an installation has them
for each in afterglow python3-afterglow; do
    doc=tree/usr/share/doc/$each
    [[ -s $doc/copyright && $(zcat "$doc/changelog.gz") == "# Changelog"* ]] || fail "$each: no copyright or changelog"
    changelog=$(zcat "$doc/changelog.Debian.gz")
    [[ $changelog == "$each ($version-1) "* ]] || fail "changelog.Debian begins otherwise: $changelog"
    [[ $changelog == *" -- Ann Packager <ann@example.org>  Tue, 14 Nov 2023 22:13:20 +0000" ]] || fail "who and when: $changelog"
done
python_files=$(dpkg-deb -c "$python_package" | awk '$1 !~ /^d/ && $6 !~ /share\/doc/ { print $6 }' | LC_ALL=C sort)
module=./usr/lib/python3/dist-packages/afterglow
[[ $python_files == "$(cd "$AFTERGLOW_BUILD_DIR/python/afterglow" && printf "$module/%s\n" *.* | LC_ALL=C sort)" ]] || fail "the Python package holds $python_files"
for script in postinst prerm; do
    dpkg-deb --ctrl-tarfile "$python_package" | tar -x --to-stdout "./$script" >"$script"
    sh -n "$script" || fail "$script is no shell script"
done
grep -q 'py3compile -p python3-afterglow' postinst || fail "bytecode is not made"
grep -q 'py3clean -p python3-afterglow' prerm || fail "bytecode is not removed"
! grep -rlF "$AFTERGLOW_BUILD_DIR" tree || fail "these name the folder of the build"
if find tree -perm /022 ! -type l | grep .; then
    fail "these may be written by others"
fi
for binary in bin/afterglow lib/libafterglow.so.*.*; do
    ! readelf -S "tree/usr/"$binary | grep '\.symtab' >/dev/null || fail "$binary is not stripped"
done
dpkg-deb --ctrl-tarfile "$package" | tar -x --to-stdout ./shlibs | grep '^libafterglow 0.1 afterglow' >/dev/null ||
    fail "no shlibs for libafterglow"
dpkg-deb --ctrl-tarfile "$package" | tar -x --to-stdout ./triggers | grep -x 'activate-noawait ldconfig' >/dev/null ||
    fail "the linker's cache is not renewed"
echo "ok: files"

# As an installation has it, but for the linker's cache.
if find_python_with_numpy; then
    (
        export LD_LIBRARY_PATH=$folder/tree/usr/lib PYTHONPATH=$folder/tree/usr/lib/python3/dist-packages
        export PYTHONDONTWRITEBYTECODE=1
        unset AFTERGLOW_LIBRARY
        loaded=$("$python" -c 'import afterglow; print(afterglow.version(), afterglow.__file__, open("/proc/self/maps").read())')
        [[ $loaded == "$version $PYTHONPATH/afterglow/__init__.py "*"$LD_LIBRARY_PATH/libafterglow.so"* ]] ||
            fail "not what was unpacked: $loaded"
        check_readme_python
    )
    echo "ok: README's lines of Python, from the packages"
else
    echo "skipped: numpy for Python is not installed"
fi

if command -v lintian >/dev/null; then
    lintian --fail-on error "$package" "$python_package" || fail "lintian"
else
    echo "lintian is not installed: its opinion was not asked"
fi
