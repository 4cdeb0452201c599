#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Feeds a log of CSV tables to `helixnav stream` as if it came from a vehicle, and prints where the vehicle is.

    helixnav new-vehicle robot
    examples/live/feed.py robot                                # starts helixnav stream itself
    examples/live/feed.py robot --speed 1                      # in the log's own time

    helixnav stream --vehicle robot/vehicle.toml --listen tcp:4711 &
    examples/live/feed.py robot --connect tcp:4711             # or unix:PATH

On a vehicle, `lines()` is what your driver does: a line for each odometry sample and for each scan, in order of time.
"""
import argparse
import csv
import json
import os
import socket
import subprocess
import sys
import threading
import time


def rows(path):
    """Time in seconds and the cells that are not empty, as they stand."""
    with open(path, newline="", encoding="utf-8-sig") as table:
        for row in csv.DictReader(table):
            cells = {name: cell for name, cell in row.items() if cell}
            yield float(row["t_s"]), cells


def lines(folder):
    """Odometry and scans in order of time. All detections of a scan stand on one line."""
    scans = {}
    for t, row in rows(os.path.join(folder, "detections.csv")):
        scans.setdefault(t, []).append(row)
    events = [(t, 0, {"detections": scan}) for t, scan in scans.items()]
    events += [(t, 1, {"odometry": row}) for t, row in rows(os.path.join(folder, "odometry.csv"))]
    for t, _, event in sorted(events, key=lambda event: event[:2]):
        yield t, json.dumps(event)


def feed(to, folder, speed):
    begin, first = time.monotonic(), None
    try:
        for t, line in lines(folder):
            first = t if first is None else first
            if speed > 0:
                time.sleep(max(0.0, (t - first) / speed - (time.monotonic() - begin)))
            to.write(line + "\n")
            to.flush()
        to.close()
    except BrokenPipeError:
        pass  # what the program said of it is printed below


def show(answers):
    for line in answers:
        kind, answer = next(iter(json.loads(line).items()))
        if kind != "scan":
            print(kind, json.dumps(answer))
            continue
        used = sum(a["outcome"] == "matched" for a in answer["associations"])
        print(f"{answer['t']:9.2f} s  x {answer['x']:8.2f}  y {answer['y']:8.2f}  heading {answer['heading']:6.3f}  "
              f"{answer['mode']}  {used} of {len(answer['associations'])} matched")
        for decision in answer["decisions"]:
            print("            ", decision["sentence"])


def connect(address):
    kind, where = address.split(":", 1)
    if kind == "unix":
        client = socket.socket(socket.AF_UNIX)
        client.connect(where)
    else:
        client = socket.create_connection(("127.0.0.1", int(where)))
    return client


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("log", help="folder with odometry.csv, detections.csv and vehicle.toml")
    parser.add_argument("--connect", metavar="ADDRESS", help="unix:PATH or tcp:PORT of a running helixnav stream")
    parser.add_argument("--helixnav", default="helixnav", help="the program to start")
    parser.add_argument("--speed", type=float, default=0.0, help="1: real time; 0: as fast as it is answered")
    options = parser.parse_args()
    if options.connect:
        client = connect(options.connect)
        to, answers = client.makefile("w"), client.makefile("r")
    else:
        command = [options.helixnav, "stream", "--vehicle", os.path.join(options.log, "vehicle.toml")]
        program = subprocess.Popen(command, stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True)
        to, answers = program.stdin, program.stdout
    # Answers are read while lines are written: the program waits for a reader that is slow.
    feeder = threading.Thread(target=feed, args=(to, options.log, options.speed), daemon=True)
    feeder.start()
    if options.connect:
        threading.Thread(target=lambda: (feeder.join(), client.shutdown(socket.SHUT_WR)), daemon=True).start()
    show(answers)
    return 0 if options.connect else program.wait()


if __name__ == "__main__":
    sys.exit(main())
