#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""What Python adds to a scan, beside the same log navigated by the loop in C++, in turns in one process.

    PYTHONPATH=build/dev/python python3 bench/python_throughput.py [SCENARIO [ROUNDS]]
"""
import statistics
import sys
import time

import helixnav


def seconds(work):
    begin = time.perf_counter()
    work()
    return time.perf_counter() - begin


def take_all(log, events):
    navigator = helixnav.Navigator(log)
    for event in events:
        navigator.take(event)


def as_arrays(event):
    """What a driver in Python has: numbers in arrays, no events yet."""
    if isinstance(event, helixnav.Odometry):
        return helixnav.Odometry, (event.t, event.increment, event.covariance), {}
    return helixnav.Scan, (event.t, event.kinds[0] if len(event) else "range_bearing", event.z, event.R), \
        {"mounting": event.mounting, "view": event.view}


def take_arrays(log, rows):
    navigator = helixnav.Navigator(log)
    for kind, arguments, named in rows:
        navigator.take(kind(*arguments, **named))


def main():
    log = helixnav.simulate(sys.argv[1] if len(sys.argv) > 1 else "large-loop", seed=1)
    rounds = int(sys.argv[2]) if len(sys.argv) > 2 else 7
    events = log.events
    rows = [as_arrays(event) for event in events]
    scans = sum(isinstance(event, helixnav.Scan) for event in events)
    times = {"replay, in C++": [], "take, from Python": [], "take of arrays, from Python": []}
    for _ in range(rounds):
        for name, work in zip(times, (lambda: helixnav.replay(log), lambda: take_all(log, events),
                                      lambda: take_arrays(log, rows))):
            times[name].append(seconds(work))
    base = times["replay, in C++"]
    print(f"{log.name}: {scans} scans, {len(events)} events, {rounds} rounds")
    for name, taken in times.items():
        ratio = statistics.median(t / b for t, b in zip(taken, base))
        print(f"{name:28s} {1e6 * statistics.median(taken) / scans:8.1f} us a scan, {ratio:.2f} of C++")


main()
