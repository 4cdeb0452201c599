#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""From a drive to an evaluated map, three ways: as a whole, step by step, and with your own events.

    PYTHONPATH=build/dev/python python3 examples/python/tutorial.py [PICTURE.svg]
"""
import sys

import numpy as np

import helixnav

# 1. A log as a whole. For your own: helixnav.read_log("my_drive"), see docs/your_own_log.md.
log = helixnav.simulate("circuit", seed=1)
run = helixnav.replay(log)  # out="runs/circuit" writes the run folder with report.html
judged = run.evaluate()
print(f"{len(run)} scans, {len(run.map)} landmarks, RMSE {judged['error']['rmse_m']:.2f} m")
print(run.explain())

# 2. Step by step: the same numbers.
navigator = helixnav.Navigator(log)
for event in log.events:
    report = navigator.take(event)  # None unless the event is a scan
    for decision in report.decisions if report else []:
        print(f"{report.t:7.1f} s  {decision.sentence}")
assert np.array_equal(navigator.map.means, run.map.means)
sigma_m = np.sqrt(navigator.map.covariances.trace(axis1=1, axis2=2))
print(f"landmarks are known to {np.median(sigma_m):.2f} m, the vehicle is at {navigator.pose}")

# 3. Your own events: a robot that drives in a circle among four poles and knows its sensor.
poles = np.array([[6.0, 0.0], [0.0, 6.0], [-6.0, 0.0], [0.0, -6.0]])
view = helixnav.FieldOfView(max_range=15.0)
robot = helixnav.Navigator(options={"slip.enabled": False})
noise = np.random.default_rng(1)
truth = np.zeros(3)
for k in range(200):
    step = np.array([0.1, 0.0, 0.1 / 3.0])  # a circle of radius 3 m
    c, s = np.cos(truth[2]), np.sin(truth[2])
    truth += [c * step[0], s * step[0], step[2]]
    robot.move(helixnav.Odometry(0.1 * k, step + noise.normal(0, [0.005, 0.001, 0.002]), np.diag([25e-6, 1e-6, 4e-6])))
    c, s = np.cos(truth[2]), np.sin(truth[2])
    seen = (poles - truth[:2]) @ np.array([[c, -s], [s, c]])  # in the robot's frame
    robot.observe(helixnav.Scan(0.1 * k, "cartesian", seen + noise.normal(0, 0.05, seen.shape), 0.05**2 * np.eye(2),
                                view=view))
error_m = np.linalg.norm(robot.pose.mean[:2] - truth[:2])
print(f"own robot: {len(robot.map)} poles, {error_m:.2f} m from the truth")
assert len(robot.map) == 4 and error_m < 0.2

# 4. A picture, without a plotting library: paths and landmarks, y upwards.
if len(sys.argv) > 1:
    estimate, truth, landmarks = run.trajectory[:, 1:3], log.true_poses[:, 1:3], run.map.means
    left, low = np.vstack([estimate, truth, landmarks]).min(axis=0) - 5.0
    wide, high = np.vstack([estimate, truth, landmarks]).max(axis=0) + 5.0 - [left, low]

    def way(points, colour, width):
        places = " ".join(f"{x:.2f},{-y:.2f}" for x, y in points)
        return f'<polyline points="{places}" fill="none" stroke="{colour}" stroke-width="{width}"/>\n'

    with open(sys.argv[1], "w", encoding="utf-8") as picture:
        picture.write(f'<svg xmlns="http://www.w3.org/2000/svg" width="800" viewBox="{left:.1f} {-low - high:.1f} '
                      f'{wide:.1f} {high:.1f}">\n<title>{log.name}: truth grey, estimate blue, landmarks red</title>\n')
        picture.write('<rect x="-1e5" y="-1e5" width="2e5" height="2e5" fill="white"/>\n')
        picture.write(way(truth, "#aaaaaa", 0.6) + way(estimate, "#1f5fbf", 0.2))
        for x, y in landmarks:
            picture.write(f'<circle cx="{x:.2f}" cy="{-y:.2f}" r="0.5" fill="#c03030"/>\n')
        picture.write("</svg>\n")
    print("picture:", sys.argv[1])
