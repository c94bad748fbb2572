#!/bin/bash
#SBATCH --array=1-16
#SBATCH --cpus-per-task=1
#SBATCH --time=1:00:00
# An ensemble as an array of Slurm jobs: a task is a shard, in a folder that all nodes share, and the
# task that finds all parts there joins them.
#
#   sbatch tools/cluster/slurm_array.sh rattleback_reversals.toml /scratch/reversals
#
# A task that died leaves its finished chunks: the same command again computes what is missing.
# HAMEL is the program, if it is not in the path.
set -euo pipefail
file=${1:?expected FILE.toml FOLDER} folder=${2:?expected FILE.toml FOLDER}
hamel=${HAMEL:-hamel}
"$hamel" ensemble "$file" -o "$folder" --quiet --threads "${SLURM_CPUS_PER_TASK:-1}" \
  --shard "${SLURM_ARRAY_TASK_ID:?not a task of an array}/${SLURM_ARRAY_TASK_COUNT:?not a task of an array}"
# Two tasks that end together may both join: the program lets one do so at a time, with the same bytes.
if ! lacks=$("$hamel" ensemble "$file" -o "$folder" --quiet --merge 2>&1); then
  echo "$lacks: the last task to end joins the parts"
fi
