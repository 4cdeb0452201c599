#!/bin/bash
# SPDX-License-Identifier: BSD-3-Clause
#SBATCH --job-name=helixnav
#SBATCH --requeue
#SBATCH --open-mode=append
# A campaign as a Slurm array: each task drives its share of the seeds into a folder of its own.
#
#   sbatch --array=1-20 --cpus-per-task=8 slurm_array.sh OUT RUNS SCENARIO [options of montecarlo]
#   helixnav montecarlo --merge OUT/part_* --out OUT/merged           # when all tasks have ended
#
# OUT is on a file system that all nodes see. A task that is killed and requeued goes on where it was; so does one whose
# command is given again.
set -euo pipefail
out=$1 runs=$2
shift 2
task=$((SLURM_ARRAY_TASK_ID - SLURM_ARRAY_TASK_MIN)) tasks=$SLURM_ARRAY_TASK_COUNT
first=$((task * runs / tasks + 1)) last=$(((task + 1) * runs / tasks))
((first <= last)) || exit 0 # more tasks than runs
exec "${HELIXNAV:-helixnav}" montecarlo "$@" --seeds "$first:$last" --jobs "${SLURM_CPUS_PER_TASK:-1}" --quiet \
  --out "$out/part_$(printf %05d "$SLURM_ARRAY_TASK_ID")"
