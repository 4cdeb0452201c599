# SPDX-License-Identifier: BSD-3-Clause
"""What nonsense, signals and wrong options come to."""
import numpy as np
import pytest

import helixnav

VIEW = helixnav.FieldOfView(max_range=20.0)


def circle_with_wrong_names(share, seed, steps=240):
    """Events round a circle of twenty landmarks, some of them named as others."""
    random = np.random.default_rng(seed)
    trees = random.uniform(-14.0, 14.0, (20, 2))
    pose, events = np.zeros(3), []
    for k in range(steps):
        pose = np.array([9.0 * np.sin(0.05 * k), 9.0 - 9.0 * np.cos(0.05 * k), 0.05 * k])
        increment = np.array([18.0 * np.sin(0.025) * np.cos(0.025), 18.0 * np.sin(0.025) ** 2, 0.05])
        events.append((helixnav.Odometry(k, increment + random.normal(0, [0.02, 0.01, 0.004]),
                                         np.diag([4e-4, 1e-4, 1.6e-5])), None))
        d = trees - pose[:2]
        ranges = np.hypot(*d.T)
        near = np.flatnonzero((ranges < 12.0) & (ranges > 0.1))
        bearings = np.arctan2(d[near, 1], d[near, 0]) - pose[2]
        z = np.c_[ranges[near] + random.normal(0, 0.1, len(near)),
                  np.arctan2(np.sin(bearings), np.cos(bearings)) + random.normal(0, 0.01, len(near))]
        names = np.where(random.random(len(near)) < share, random.integers(0, 20, len(near)), near)
        z[:, 0] = np.maximum(z[:, 0], 0.05)
        events.append((helixnav.Scan(k, "range_bearing", z, np.diag([0.01, 1e-4]), view=VIEW), names))
    return events


def end_of(options, share, seed):
    navigator = helixnav.NamedNavigator(options=options)
    for event, names in circle_with_wrong_names(share, seed):
        navigator.take(event) if names is None else navigator.take(event, names)
    return navigator.pose.mean


@pytest.mark.parametrize("share, seed", [(0.03, 8), (0.03, 15), (0.1, 2), (0.1, 13), (0.3, 2), (0.3, 3)])
def test_wrong_names_end_no_drive(share, seed):
    assert np.all(np.isfinite(end_of({}, share, seed)))


def test_a_scan_that_cannot_be_computed_with_is_left_out_with_a_decision():
    navigator = helixnav.NamedNavigator()
    seen = [helixnav.Scan(t, "range_bearing", [z], np.diag([0.01, 1e-4]), view=VIEW)
            for t, z in enumerate(([2.0, 0.0], [1.0, 0.0], [0.5, 0.0], [3.0, 0.0]))]
    navigator.observe(seen[0], [7])
    exactly = helixnav.Odometry(1.0, [2.0, 0.0, 0.0], np.zeros((3, 3)))  # onto the landmark
    navigator.move(exactly)
    report = navigator.observe(seen[1], [7])
    assert [(d.kind, d.verdict, d.numbers) for d in report.decisions] == [("scan", "left-out", {"observations": 1.0})]
    assert report.associations[0].outcome == "rejected" and report.pose.x == 2.0
    navigator.move(helixnav.Odometry(2.0, [-1.0, 0.0, 0.0], 1e-4 * np.eye(3)))
    report = navigator.observe(seen[2], [7])
    assert report.associations[0].outcome == "matched" and not report.decisions and report.step == 2
