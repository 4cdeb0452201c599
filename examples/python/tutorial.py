#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""From a drive to a judged map, three times: as a whole, step by step, and with events of one's own.

    PYTHONPATH=build/dev/python examples/python/tutorial.py [PICTURE.png]

The picture needs matplotlib; everything else needs NumPy only.
"""
import sys

import numpy as np

import helixnav

# 1. A log as a whole. Of your own: helixnav.read_log("my_drive"), as docs/your_own_log.md says.
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

# 3. Events of one's own: a robot that drives a circle among four poles and knows its sensor.
poles = np.array([[6.0, 0.0], [0.0, 6.0], [-6.0, 0.0], [0.0, -6.0]])
view = helixnav.FieldOfView(max_range=15.0)
robot = helixnav.Navigator(options={"slip.enabled": False})
noise = np.random.default_rng(1)
truth = np.zeros(3)
for k in range(200):
    step = np.array([0.1, 0.0, 0.1 / 3.0])  # a circle of 3 m
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

if len(sys.argv) > 1:
    try:
        import matplotlib
    except ImportError:
        sys.exit("no picture: matplotlib is missing")
    matplotlib.use("Agg")
    from matplotlib import pyplot

    pyplot.plot(*run.trajectory[:, 1:3].T, label="estimate")
    pyplot.plot(*log.true_poses[:, 1:3].T, label="truth")
    pyplot.plot(*run.map.means.T, ".", label="landmarks")
    pyplot.axis("equal")
    pyplot.legend()
    pyplot.savefig(sys.argv[1])
    print("picture:", sys.argv[1])
