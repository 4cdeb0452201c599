#!/usr/bin/env python3
"""Digests of what the navigator does on logs and simulated drives, to be compared before and after a change that must not
change it: behaviour_digest.py HELIXNAV DATA [--first-seed N] [--seeds K] > digests.txt. One line a drive: name, then the
SHA-256 of trajectory.tum, map.csv and associations.csv."""
import argparse
import hashlib
import pathlib
import subprocess
import sys
import tempfile

LOGS = {
    "victoria-park": ["victoria_park/raw/victoria_park_ascii.zip"],
    "car-park": ["carpark/raw/data_set.mat"],
    "isam-graph": ["victoria_park_graph/raw/isam_victoriaPark.txt", "--association", "known"],
    "plaza": ["plaza", "--association", "known"],
    "dlr-known": ["dlr/raw/map.circles", "--association", "known"],
    "dlr-unknown": ["dlr/raw/map.circles"],
}
SCENARIOS = ["large-loop-changed", "sparse", "figure-of-eight", "orchard"]
FILES = ["trajectory.tum", "map.csv", "associations.csv"]


def digest(command, folder):
    done = subprocess.run(command + ["--out", folder, "--quiet"], stdout=subprocess.DEVNULL, stderr=subprocess.PIPE)
    if done.returncode != 0:
        return [f"exit-{done.returncode}:{done.stderr.decode().strip().splitlines()[-1:]}"]
    return [hashlib.sha256((pathlib.Path(folder) / name).read_bytes()).hexdigest()[:16] for name in FILES]


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("helixnav")
    parser.add_argument("data", type=pathlib.Path)
    parser.add_argument("--first-seed", type=int, default=100001)
    parser.add_argument("--seeds", type=int, default=200)
    options = parser.parse_args()
    drives = [(name, [options.helixnav, "replay", str(options.data / log[0]), *log[1:]]) for name, log in LOGS.items()]
    for scenario in SCENARIOS:
        for seed in range(options.first_seed, options.first_seed + options.seeds):
            drives.append((f"{scenario}-{seed}", [options.helixnav, "simulate", scenario, "--seed", str(seed)]))
    for name, command in drives:
        with tempfile.TemporaryDirectory() as folder:
            print(name, *digest(command, folder + "/run"), flush=True)


if __name__ == "__main__":
    sys.exit(main())
