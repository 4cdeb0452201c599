#!/bin/bash
# SPDX-License-Identifier: BSD-3-Clause
# A campaign by GNU parallel, here or on the machines of PARALLEL_OPTIONS:
#
#   gnu_parallel.sh OUT RUNS PARTS SCENARIO [options of montecarlo]
#   PARALLEL_OPTIONS="--sshlogin 4/ada,4/bob" gnu_parallel.sh /shared/out 2000 20 large-loop-changed
#
# Then OUT/merged is the whole campaign, of the parts of this call (OUT/part_FIRST-LAST). OUT is on a file system that all machines see. What was killed goes on by the same
# command.
set -euo pipefail
((BASH_VERSINFO[0] >= 4))
out=$1 runs=$2 parts=$3
shift 3
read -ra options <<<"${PARALLEL_OPTIONS:-}"
mkdir -p "$out"
folders=()
for ((part = 0; part < parts; ++part)); do
  first=$((part * runs / parts + 1)) last=$(((part + 1) * runs / parts))
  if ((first <= last)); then folders+=("$out/part_$first-$last"); fi
done
printf '%s\n' "${folders[@]}" | sed 's/\(.*part_\)\([0-9]*\)-\([0-9]*\)$/\2:\3\t&/' |
  parallel "${options[@]}" --colsep '\t' --halt soon,fail=1 \
    "${HELIXNAV:-helixnav}" montecarlo "$(printf '%q ' "$@")" --jobs 1 --quiet --seeds {1} --out {2} '>/dev/null'
"${HELIXNAV:-helixnav}" montecarlo --merge "${folders[@]}" --out "$out/merged" --overwrite
