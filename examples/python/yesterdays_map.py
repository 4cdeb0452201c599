#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Continuing in yesterday's map: from anywhere on it, after being carried, and joining two drives afterwards.

    PYTHONPATH=build/dev/python python3 examples/python/yesterdays_map.py
"""
import numpy as np

import helixnav

TREES = np.random.default_rng(7).uniform([-30.0, -14.0], [30.0, 46.0], size=(60, 2))
VIEW = helixnav.FieldOfView(max_range=15.0)
RADIUS = 16.0  # of the circle that the robot drives, 1 m per scan


def pose_at(along):
    angle = along / RADIUS
    return np.array([RADIUS * np.sin(angle), RADIUS * (1.0 - np.cos(angle)), angle])


def drive(navigator, begin, end, noise):
    """Feeds the navigator the path from one distance [m] to another; yields the decisions as sentences."""
    for along in np.arange(begin, end):
        step = pose_at(1.0) + noise.normal(0.0, [0.02, 0.005, 0.005])
        navigator.move(helixnav.Odometry(along, step, np.diag([4e-4, 25e-6, 25e-6])))
        x, y, heading = pose_at(along + 1.0)
        c, s = np.cos(heading), np.sin(heading)
        trees = (TREES - [x, y]) @ np.array([[c, -s], [s, c]])  # in the robot's frame
        trees = trees[np.linalg.norm(trees, axis=1) < 15.0]
        seen = trees + noise.normal(0.0, 0.05, trees.shape)
        report = navigator.observe(helixnav.Scan(along, "cartesian", seen, 0.05**2 * np.eye(2), view=VIEW))
        yield from (decision.sentence for decision in report.decisions)


noise = np.random.default_rng(1)
options = {"slip.enabled": False}
monday = helixnav.Navigator(options=options)
list(drive(monday, 0.0, 110.0, noise))
map_of_monday = monday.joint_map(reach=15.0)  # or helixnav.read_map("runs/monday") for a run folder

# 1. Tuesday begins 35 m along the path, which the navigator is not told.
tuesday = helixnav.Navigator(options=options)
tuesday.look_for_place_in(map_of_monday)
for sentence in drive(tuesday, 35.0, 95.0, noise):
    print(sentence)
assert not tuesday.maps_apart, "one map, in Monday's frame"
error = np.linalg.norm(tuesday.pose.mean[:2] - pose_at(95.0)[:2])
print(f"on Monday's map, {error:.2f} m from the truth")
assert error < 0.5

# 2. Carried, and told so: it searches for its place again in everything mapped so far.
tuesday.take(helixnav.Lost(95.0))
for sentence in drive(tuesday, 120.0, 180.0, noise):
    print(sentence)
error = np.linalg.norm(tuesday.pose.mean[:2] - pose_at(180.0)[:2])
print(f"found again, {error:.2f} m from the truth")
assert not tuesday.maps_apart and error < 0.5

# 3. Two drives with nothing connecting them as they ran become one map.
wednesday = helixnav.Navigator(options=options)
list(drive(wednesday, 50.0, 150.0, noise))
joined = helixnav.join([map_of_monday, wednesday.joint_map(reach=15.0)])
print(f"{len(joined.components)} map of {len(joined.components[0])} landmarks; " +
      ", ".join(f"{kind}: {sum(c.change == kind for c in joined.changes)}" for kind in ("kept", "gone", "new", "moved")))
assert len(joined.components) == 1
