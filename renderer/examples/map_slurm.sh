#!/usr/bin/env bash
#SBATCH --job-name=afterglow
# map_slurm.sh SCENE OUT.exr N [OPTION]...: one picture in N bands by Slurm, like tiles_slurm.sh, on nodes that share no more
# than a network's file system, where a photon map is read but not filled: each job fills a copy of its own on its node,
# and a last one puts the copies together (afterglow-map merge). The map, OUT.photons, then has all irradiances of the
# picture, for the next one. Options of sbatch go into $SBATCH_OPTIONS.
set -euo pipefail

scene=$1 out=$2 count=$3
shift 3
afterglow=${AFTERGLOW:-afterglow}
afterglow_map=${AFTERGLOW_MAP:-afterglow-map}
map=${out%.exr}.photons
part() { echo "${out%.exr}.part$1.exr"; }

submit() { # SBATCH-OPTION... -- ARGUMENT-OF-THIS-SCRIPT...
    local -a options
    read -ra options <<<"${SBATCH_OPTIONS:-}"
    while [[ $1 != -- ]]; do
        options+=("$1")
        shift
    done
    shift
    sbatch --parsable --kill-on-invalid-dep=yes "${options[@]}" "$script" "$@"
}

if [[ -z ${SLURM_JOB_ID:-} ]]; then
    script=$0
    photons=$(AFTERGLOW_STEP=photons submit -- "$scene" "$out" "$count" "$@")
    bands=$(AFTERGLOW_STEP=bands submit --array="1-$count" --dependency="afterok:${photons%%;*}" -- \
        "$scene" "$out" "$count" "$@")
    AFTERGLOW_STEP=merge submit --wait --dependency="afterok:${bands%%;*}" -- "$scene" "$out" "$count"
    exit
fi

case $AFTERGLOW_STEP in
photons) exec "$afterglow" "$@" --photons-only --photon-map "$map" "$scene" ;;
bands)
    i=$SLURM_ARRAY_TASK_ID
    node=$(mktemp -d) # of the node
    trap 'rm -rf "$node"' EXIT
    cp "$map" "$node/map"
    "$afterglow" "$@" --photon-map "$node/map" --tile "$i/$count" -o "$(part "$i")" "$scene"
    cp "$node/map" "$map.$i.copying"
    mv "$map.$i.copying" "$map.$i"
    ;;
merge)
    copies=() parts=() sum=()
    for ((i = 1; i <= count; i++)); do
        copies+=("$map.$i")
        parts+=("$(part "$i")")
        sum+=("$(part "$i")")
        ((i == 1)) || sum+=(--add)
    done
    "$afterglow_map" merge "$map" "$map" "${copies[@]}"
    oiiotool "${sum[@]}" -o "$out" # bands do not overlap: their sum is the picture, to the last bit
    rm -- "${copies[@]}" "${parts[@]}"
    ;;
esac
