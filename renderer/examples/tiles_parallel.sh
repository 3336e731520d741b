#!/usr/bin/env bash
# tiles_parallel.sh SCENE OUT.exr N [OPTION]...: one picture in N bands, by GNU parallel, put together by oiiotool.
# For several machines give parallel their names, in $PARALLEL: PARALLEL="--sshlogin a,b --workdir ." tiles_parallel.sh ...
# May be called again after a failure: bands that are complete are not rendered twice.
set -euo pipefail

scene=$1 out=$2 count=$3
shift 3
afterglow=${AFTERGLOW:-afterglow}
mapfile -t parts < <(for ((i = 1; i <= count; i++)); do echo "${out%.exr}.part$i.exr"; done)

parallel --halt soon,fail=1 --jobs "${JOBS:-1}" --quote \
    "$afterglow" "$@" --progress off --tile "{}/$count" --no-clobber --checkpoint 300 --resume \
    -o "${out%.exr}.part{}.exr" "$scene" ::: $(seq "$count")

# Bands do not overlap: their sum is the picture, to the last bit.
merge=("${parts[0]}")
for part in "${parts[@]:1}"; do
    merge+=("$part" --add)
done
oiiotool "${merge[@]}" -o "$out"
rm -- "${parts[@]}"
