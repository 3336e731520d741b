#!/usr/bin/env bash
#SBATCH --job-name=afterglow
#SBATCH --requeue
#SBATCH --open-mode=append
# tiles_slurm.sh SCENE OUT.exr N [OPTION]...: one picture in N bands, as an array of Slurm jobs, put together by a job that
# waits for them. Names of files must mean the same on all nodes. A band that is stopped (a limit of time, a node taken
# away) writes a checkpoint when Slurm sends SIGTERM, and goes on from there when it is requeued.
# Options of sbatch go into $SBATCH_OPTIONS: SBATCH_OPTIONS="-c 16 -t 2:00:00" tiles_slurm.sh ...
set -euo pipefail

scene=$1 out=$2 count=$3
shift 3
afterglow=${AFTERGLOW:-afterglow}

if [[ -z ${SLURM_JOB_ID:-} ]]; then
    read -ra options <<<"${SBATCH_OPTIONS:-}"
    array=$(sbatch --parsable "${options[@]}" --array="1-$count" "$0" "$scene" "$out" "$count" "$@")
    exec sbatch --wait "${options[@]}" --dependency="afterok:${array%%;*}" --kill-on-invalid-dep=yes \
        "$0" "$scene" "$out" "$count"
elif [[ -n ${SLURM_ARRAY_TASK_ID:-} ]]; then
    # exec: the signal is for the program, not for a shell that waits for it
    exec "$afterglow" "$@" --tile "$SLURM_ARRAY_TASK_ID/$count" --no-clobber --checkpoint 300 --resume \
        -o "${out%.exr}.part$SLURM_ARRAY_TASK_ID.exr" "$scene"
fi

# Bands do not overlap: their sum is the picture, to the last bit.
merge=("${out%.exr}.part1.exr")
for ((i = 2; i <= count; i++)); do
    merge+=("${out%.exr}.part$i.exr" --add)
done
oiiotool "${merge[@]}" -o "$out"
for ((i = 1; i <= count; i++)); do
    rm -- "${out%.exr}.part$i.exr"
done
