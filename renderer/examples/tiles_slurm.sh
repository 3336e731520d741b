#!/usr/bin/env bash
#SBATCH --job-name=afterglow
#SBATCH --requeue
#SBATCH --open-mode=append
# tiles_slurm.sh SCENE OUT.exr N [OPTION]...: one picture in N bands by Slurm: a job that makes the photon map, an array of
# jobs that render bands with it, and a job that waits for them and puts them together. Names of files must mean the same
# on all nodes. A band that is stopped (a limit of time, a node taken away) writes a checkpoint when Slurm sends SIGTERM,
# and goes on from there when it is requeued.
# Options of sbatch go into $SBATCH_OPTIONS: SBATCH_OPTIONS="-c 16 -t 2:00:00" tiles_slurm.sh ...
set -euo pipefail

scene=$1 out=$2 count=$3
shift 3
afterglow=${AFTERGLOW:-afterglow}
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
    AFTERGLOW_STEP=picture submit --wait --dependency="afterok:${bands%%;*}" -- "$scene" "$out" "$count"
    exit
fi

# exec: signals are for the program, not for a shell that waits for it
case $AFTERGLOW_STEP in
photons) exec "$afterglow" "$@" --photons-only --photon-map "$map" "$scene" ;;
bands)
    exec "$afterglow" "$@" --photon-map "$map" --tile "$SLURM_ARRAY_TASK_ID/$count" --no-clobber --checkpoint 300 \
        --resume -o "$(part "$SLURM_ARRAY_TASK_ID")" "$scene"
    ;;
picture) # bands do not overlap: their sum is the picture, to the last bit
    parts=("$(part 1)") merge=("$(part 1)")
    for ((i = 2; i <= count; i++)); do
        parts+=("$(part "$i")")
        merge+=("$(part "$i")" --add)
    done
    oiiotool "${merge[@]}" -o "$out"
    rm -- "${parts[@]}" "$map"
    ;;
esac
