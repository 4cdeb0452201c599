# SPDX-License-Identifier: BSD-3-Clause
"""A view across the back is that of a sensor which looks backwards."""
import numpy as np
import pytest

import helixnav


def seen_backwards(view, heading, azimuth):
    """To and fro before landmarks behind the robot, of which the first, at `azimuth`, is gone after a third of the scans."""
    random = np.random.default_rng(0)
    landmarks = np.array([[8 * np.cos(azimuth), 8 * np.sin(azimuth)], [-6, 3], [-7, -3], [-9, 0.5], [-4, -6], [-4, 6]])
    navigator, x = helixnav.Navigator(), 0.0
    for k in range(120):
        dx = 0.05 if (k // 20) % 2 == 0 else -0.05
        x += dx
        navigator.move(helixnav.Odometry(0.1 * k, [dx, 0, 0], np.diag([1e-6, 1e-7, 1e-8])))
        d = (landmarks if k < 40 else landmarks[1:]) - [x, 0]
        bearings = np.arctan2(d[:, 1], d[:, 0]) - heading + random.normal(0, 0.01, len(d))
        z = np.c_[np.hypot(*d.T) + random.normal(0, 0.1, len(d)), np.arctan2(np.sin(bearings), np.cos(bearings))]
        navigator.observe(helixnav.Scan(0.1 * k, "range_bearing", z, np.diag([0.01, 1e-4]), mounting=(0, 0, heading),
                                        view=view))
    return navigator.map


@pytest.mark.parametrize("degrees", [150, 170, -170, -150])
def test_what_is_gone_is_forgotten_on_either_side(degrees):
    half = 0.5 * np.pi
    expected = seen_backwards(helixnav.FieldOfView(15.0, 0.0, -half, half), np.pi, np.deg2rad(degrees))
    for low in (half, -3 * half):
        found = seen_backwards(helixnav.FieldOfView(15.0, 0.0, low, low + np.pi), 0.0, np.deg2rad(degrees))
        assert len(found) == len(expected) == 5
        np.testing.assert_allclose(found.means, expected.means, atol=1e-6)
