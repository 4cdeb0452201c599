#!/usr/bin/env python3
"""Navigates the same simulated drives with programs of two compilers and compares what they wrote:
same_by_compilers.py HELIXNAV OTHER_HELIXNAV [--data DIR]. Landmarks, outcomes and partners have to be the same, and numbers of
trajectory.tum, map.csv and associations.csv within 1e-9 of the other (of its size, where that is larger than 1). One line a drive
and table: the largest difference. --data: the real logs, too. Status 1 where something differs by more."""
import argparse
import math
import pathlib
import subprocess
import sys
import tempfile

LIMIT = 1e-9
DRIVES = [
    ["simulate", "large-loop-changed", "--seed", "3"],
    ["simulate", "two-laps", "--seed", "3"],
    ["simulate", "figure-of-eight", "--seed", "3"],
]
LOGS = [["victoria_park/raw/victoria_park_ascii.zip"], ["dlr/raw/map.circles", "--association", "known"]]
TABLES = [("trajectory.tum", " "), ("map.csv", ","), ("associations.csv", ",")]


def navigate(program, drive, folder):
    subprocess.run([program, *drive, "--out", folder, "--quiet"], check=True, stdout=subprocess.DEVNULL)


def rows(path, separator):
    return [line.split(separator) for line in path.read_text().splitlines()[1:]]


def difference(a, b):
    """Of two cells: 0 where they are the same, inf where they cannot be compared."""
    if a == b:
        return 0.0
    try:
        x, y = float(a), float(b)
    except ValueError:
        return math.inf
    if x == y:
        return 0.0
    if "." not in a + b and "e" not in a + b:  # whole numbers are names and counts
        return math.inf
    apart = abs(x - y) / max(1.0, abs(x))
    return math.inf if math.isnan(apart) else apart


def largest_difference(one, other):
    """With the number of the row where it is."""
    if len(one) != len(other):
        return math.inf, min(len(one), len(other))
    worst = (0.0, 0)
    for number, (a, b) in enumerate(zip(one, other)):
        apart = max(map(difference, a, b)) if len(a) == len(b) else math.inf
        worst = max(worst, (apart, number))
    return worst


def compare(programs, drive):
    same = True
    with tempfile.TemporaryDirectory() as scratch:
        folders = [pathlib.Path(scratch) / name for name in ("one", "other")]
        for program, folder in zip(programs, folders):
            navigate(program, drive, str(folder))
        for table, separator in TABLES:
            apart, row = largest_difference(*(rows(folder / table, separator) for folder in folders))
            same = same and apart <= LIMIT
            where = "" if apart == 0.0 else f" (row {row + 1})"
            print(f"{' '.join(map(str, drive[1:]))}  {table}: {apart:.2g}{where}", flush=True)
    return same


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("programs", nargs=2)
    parser.add_argument("--data", type=pathlib.Path)
    options = parser.parse_args()
    drives = list(DRIVES)
    if options.data:
        drives += [["replay", str(options.data / log[0]), *log[1:]] for log in LOGS]
    results = [compare(options.programs, drive) for drive in drives]
    return 0 if all(results) else 1


sys.exit(main())
