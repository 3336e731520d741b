#!/usr/bin/env bash
#SBATCH --job-name=afterglow
#SBATCH --requeue
#SBATCH --open-mode=append
# tiles_slurm.sh SCENE OUT.exr N [OPTION]...: one picture in N bands by Slurm: a job that makes the photon map, an array of
# jobs that render bands with it, and a job that waits for them and puts them together. Names of files must mean the same
# on all nodes. A band that is stopped (a limit of time, a node taken away) writes a checkpoint when Slurm sends SIGTERM,
# and goes on from there when it is requeued.
#
# AFTERGLOW_MAP_COPIES=yes: for nodes that share no more than a network's file system, where a photon map is read but not
# filled. Each job fills a copy of the map on its own node, and the last one puts the copies together (afterglow-map
# merge). The map, OUT.photons, stays: it has all irradiances of the picture, for the next one.
#
# Options of sbatch go into $SBATCH_OPTIONS: SBATCH_OPTIONS="-c 16 -t 2:00:00" tiles_slurm.sh ...
set -euo pipefail

scene=$1 out=$2 count=$3
shift 3
afterglow=${AFTERGLOW:-afterglow}
map=${out%.exr}.photons
copies=${AFTERGLOW_MAP_COPIES:-no}
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
    AFTERGLOW_STEP=picture submit --wait --dependency="afterok:${bands%%;*}" -- "$scene" "$out" "$count"
    exit
fi

case $AFTERGLOW_STEP in
photons) exec "$afterglow" "$@" --photons-only --photon-map "$map" "$scene" ;; # exec: signals are for the program
bands)
    i=$SLURM_ARRAY_TASK_ID
    band=(--tile "$i/$count" -o "$(part "$i")" "$scene")
    [[ $copies == yes ]] || exec "$afterglow" "$@" --photon-map "$map" --no-clobber --checkpoint 300 --resume "${band[@]}"
    node=$(mktemp -d) # of the node
    trap 'rm -rf "$node"' EXIT
    cp "$map" "$node/map"
    "$afterglow" "$@" --photon-map "$node/map" "${band[@]}"
    cp "$node/map" "$map.$i.copying"
    mv "$map.$i.copying" "$map.$i"
    ;;
picture) # bands do not overlap: their sum is the picture, to the last bit
    parts=() filled=() sum=()
    for ((i = 1; i <= count; i++)); do
        parts+=("$(part "$i")")
        filled+=("$map.$i")
        sum+=("$(part "$i")")
        ((i == 1)) || sum+=(--add)
    done
    if [[ $copies == yes ]]; then
        "${AFTERGLOW_MAP:-afterglow-map}" merge "$map" "$map" "${filled[@]}"
    else
        filled=("$map")
    fi
    oiiotool "${sum[@]}" -o "$out"
    rm -- "${parts[@]}" "${filled[@]}"
    ;;
esac
