#!/usr/bin/env bash
# Each public header is listed, to be installed, and stands alone, as C17 and as C++17, without a warning; and the library
# exports exactly the functions that they declare.
set -euo pipefail
# shellcheck source=tests/fixtures/shell_test.sh
source "$(dirname "${BASH_SOURCE[0]}")/../fixtures/shell_test.sh"
mapfile -t headers < <(cd "$root" && printf '%s\n' {threads,renderer}/include/afterglow/*.h | sed 's|.*/include/||')
includes=(-I "$root/renderer/include" -I "$root/threads/include")
warnings=(-Wall -Wextra -Wshadow -Wconversion -Wundef -pedantic -Werror)

for header in "${headers[@]}"; do
    grep -q "include/$header\>" "$root/renderer/CMakeLists.txt" || fail "renderer/CMakeLists.txt does not list $header"
    # Twice: the guard. The header first: it needs nothing before it.
    printf '#include "%s"\n#include "%s"\nint main(void) { return 0; }\n' "$header" "$header" | tee "$folder/use.c" >"$folder/use.cpp"
    "$CC" -std=c17 "${warnings[@]}" -Wstrict-prototypes "${includes[@]}" -fsyntax-only "$folder/use.c"
    "$CXX" -std=c++17 "${warnings[@]}" -Wold-style-cast "${includes[@]}" -fsyntax-only "$folder/use.cpp"
    echo "ok: $header"
done

# The declared functions: of each AG_API declaration the last word before the bracket.
cat "$root"/{threads,renderer}/include/afterglow/*.h |
    sed -nE 's/^AG_API .*[ *](ag_[a-z0-9_]+)\(.*/\1/p' | sort >"$folder/declared"
nm --dynamic --defined-only --format=posix "$AFTERGLOW_BUILD_DIR/lib/libafterglow.so" |
    awk '{ print $1 }' | sed 's/@.*//' | sort >"$folder/exported"
[[ -s $folder/declared ]] || { echo "FAILED: no declaration found"; exit 1; }
if ! diff -u --label "declared in the public headers" "$folder/declared" --label "exported" "$folder/exported"; then
    echo "FAILED: the library exports something else than its headers declare"
    exit 1
fi
echo "ok: $(wc -l <"$folder/exported") functions declared and exported"
