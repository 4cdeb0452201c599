#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""MRPT's demo through the programs kf-slam and helixnav-slam in turn: their own landmark errors, time of a step by their
own profilers, processor and wall-clock time. Medians of the runs.

usage: mrpt_demo.py HELIXNAV-SLAM [runs [folder of MRPT's datasets]]
kf-slam is Debian's package mrpt-apps. Its log files are off; helixnav-slam writes its run folder, no picture and no scenes.
"""
import os
import re
import resource
import statistics
import subprocess
import sys
import tempfile
import time
from pathlib import Path

CONFIG = """[MappingApplication]
kf_implementation = CRangeBearingKFSLAM2D
ground_truth_file = {data}/kf-slam_demo_ground_truth.txt
logOutput_dir = {out}
rawlog_offset = {offset}
SAVE_LOG_FREQUENCY = 1000000
SAVE_DA_LOG = false
SAVE_3D_SCENES = false
SAVE_MAP_REPRESENTATIONS = false
[RangeBearingKFSLAM_KalmanFilter]
method = 0
enable_profiler = true
[RangeBearingKFSLAM]
stdXY_no_odo = 0.1
stdPhi_no_odo_deg = 2
std_sensor_range = 0.03
std_sensor_yaw_deg = 0.1
[HelixNav]
enable_profiler = true
save_png = false
overwrite = true
{own}
"""
STEP = re.compile(r"complete_step\s+\d+\s+\S+\s+([0-9.]+)(ns|us|ms|s)\s")
ERROR = re.compile(r"(?:Mean Error:|landmarks to truth   mean) ([0-9.]+)")
UNIT_MS = {"ns": 1e-6, "us": 1e-3, "ms": 1.0, "s": 1e3}


def run(program, folder, data, offset=0, own=""):
    """Mean landmark error [mm], time of a step [ms], wall clock [s], processor [s]."""
    config = Path(folder) / "demo.ini"
    config.write_text(CONFIG.format(data=data, out=Path(folder) / "out", offset=offset, own=own))
    used, began = resource.getrusage(resource.RUSAGE_CHILDREN), time.monotonic()
    done = subprocess.run([program, config, f"{data}/kf-slam_demo.rawlog"], stdin=subprocess.DEVNULL,
                          stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True, check=False)
    wall_s, now = time.monotonic() - began, resource.getrusage(resource.RUSAGE_CHILDREN)
    error, step = ERROR.search(done.stdout), STEP.search(done.stdout)
    if not (error and step):
        sys.exit(f"{program} ended with {done.returncode} and said\n{done.stdout[-2000:]}")
    processor_s = now.ru_utime + now.ru_stime - used.ru_utime - used.ru_stime
    return float(error[1]) * 1e3, float(step[1]) * UNIT_MS[step[2]], wall_s, processor_s


def main():
    if len(sys.argv) < 2:
        sys.exit(__doc__)
    runs = int(sys.argv[2]) if len(sys.argv) > 2 else 11
    data = sys.argv[3] if len(sys.argv) > 3 else "/usr/share/mrpt/datasets"
    ours = os.path.abspath(sys.argv[1])
    rows = [("kf-slam, which begins at the second frame", "kf-slam", {}),
            ("helixnav-slam", ours, {}),
            ("helixnav-slam from the second frame on", ours, {"offset": 1}),
            ("the same, retraction = right-invariant", ours, {"offset": 1, "own": "retraction = right-invariant"})]
    results = [[] for _ in rows]
    with tempfile.TemporaryDirectory() as folder:
        for _ in range(runs):
            for (_, program, keys), result in zip(rows, results):
                result.append(run(program, folder, data, **keys))
    print("| | landmarks, mean error | a step | wall clock | processor |\n|---|---|---|---|---|")
    for (name, _, _), result in zip(rows, results):
        error_mm, step_ms, wall_s, processor_s = (statistics.median(column) for column in zip(*result))
        print(f"| {name} | {error_mm:.3f} mm | {step_ms:.2f} ms | {wall_s:.2f} s | {processor_s:.2f} s |")


if __name__ == "__main__":
    main()
