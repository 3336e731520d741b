#!/usr/bin/env bash
#SBATCH --job-name=afterglow
#SBATCH --requeue
#SBATCH --open-mode=append
# frames_slurm.sh SCENE OUT FRAMES [OPTION]...: an animation as an array of Slurm jobs, a frame each; returns when all are
# there. FRAMES is as --frames has it, 1-100x2 say; OUT, and SCENE where each frame has its own, have a placeholder for the
# number: shot.%04d.exr. Names of files must mean the same on all nodes. A frame that is stopped goes on from its
# checkpoint when it is requeued; called again, only frames that are missing are rendered. Where only the camera moves, all
# frames may share one photon map: frames_slurm.sh shot.%04d.pbrt shot.%04d.exr 1-100 --photon-map shot.photons
# Options of sbatch go into $SBATCH_OPTIONS: SBATCH_OPTIONS="-c 16 -t 2:00:00" frames_slurm.sh ...
set -euo pipefail

scene=$1 out=$2 frames=$3
shift 3

if [[ -z ${SLURM_JOB_ID:-} ]]; then
    read -ra options <<<"${SBATCH_OPTIONS:-}"
    exec sbatch --wait "${options[@]}" --array="${frames//x/:}" "$0" "$scene" "$out" "$frames" "$@"
fi
# exec: signals are for the program, not for a shell that waits for it
exec "${AFTERGLOW:-afterglow}" "$@" --frames "$SLURM_ARRAY_TASK_ID" --no-clobber --checkpoint 300 --resume \
    -o "$out" "$scene"
