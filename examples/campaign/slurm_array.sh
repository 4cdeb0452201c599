#!/bin/bash
# SPDX-License-Identifier: BSD-3-Clause
#SBATCH --job-name=helixnav
#SBATCH --requeue
#SBATCH --open-mode=append
# A campaign as a Slurm array: task k drives seeds (k-1)*RUNS_PER_TASK+1 to k*RUNS_PER_TASK into a folder of its own.
#
#   sbatch --array=1-20 --cpus-per-task=8 slurm_array.sh OUT RUNS_PER_TASK SCENARIO [options of montecarlo]
#   helixnav montecarlo --merge OUT/part_* --out OUT/merged           # when all tasks have ended
#
# OUT is on a file system that all nodes see. A task that is killed and requeued goes on where it was; so does one whose
# command is given again, alone, too (--array=3). What of the tasks from the first to the last is missing, --merge says.
set -euo pipefail
out=$1 each=$2 task=$SLURM_ARRAY_TASK_ID
shift 2
if ((task < 1 || each < 1)); then
  echo "slurm_array.sh: tasks are counted from 1 (--array=1-20), and each drives one run at least" >&2
  exit 2
fi
exec "${HELIXNAV:-helixnav}" montecarlo "$@" --seeds "$(((task - 1) * each + 1)):$((task * each))" \
  --jobs "${SLURM_CPUS_PER_TASK:-1}" --quiet --out "$out/part_$(printf %05d "$task")"
