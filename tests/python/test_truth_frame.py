# SPDX-License-Identifier: BSD-3-Clause
"""What a drive on an earlier map is judged by."""
import numpy as np
import pytest

import helixnav

RADIUS, REACH = 20.0, 15.0


def truth(k):
    """On a circle round the middle of the room that the truth is given in."""
    angle = 0.5 * k / RADIUS
    return np.array([RADIUS * np.cos(angle), RADIUS * np.sin(angle), angle + 0.5 * np.pi])


def turned_back(pose, points):
    c, s = np.cos(pose[2]), np.sin(pose[2])
    return (points - pose[:2]) @ np.array([[c, -s], [s, c]])


def in_room(room, pose):
    c, s = np.cos(room[2]), np.sin(room[2])
    return [*(room[:2] + np.array([[c, -s], [s, c]]) @ pose[:2]), room[2] + pose[2]]


def write_log(folder, first, last, seed, room=np.zeros(3)):
    """A log of its own beginning, of the part of the circle from `first` to `last`."""
    random = np.random.default_rng(seed)
    trees = np.random.default_rng(1).uniform(-34.0, 34.0, (60, 2))
    folder.mkdir()
    odometry, detections, poses = ["t,dx,dy,dheading"], ["t,range,bearing"], ["t,x,y,heading"]
    for k in range(first, last):
        way = turned_back(truth(k - 1), truth(k)[None, :2])[0] if k > first else np.zeros(2)
        turn = 0.5 / RADIUS if k > first else 0.0
        noise = random.normal(0.0, [0.01, 0.01, 0.002]) if k > first else np.zeros(3)
        odometry.append(f"{k},{way[0] + noise[0]:.9f},{way[1] + noise[1]:.9f},{turn + noise[2]:.9f}")
        for x, y in turned_back(truth(k), trees) + random.normal(0.0, 0.05, trees.shape):
            if np.hypot(x, y) < REACH:
                detections.append(f"{k},{np.hypot(x, y):.6f},{np.arctan2(y, x):.6f}")
        poses.append(",".join(f"{cell:.9f}" for cell in (k, *in_room(room, truth(k)))))
    (folder / "vehicle.toml").write_text(
        "[odometry]\nsigma_along_m_per_sqrt_m = 0.02\nsigma_sideways_m_per_sqrt_m = 0.02\n"
        "sigma_heading_deg_per_sqrt_m = 0.2\n[[sensor]]\nreach_m = 15\nview_deg = [-180, 180]\n"
        "sigma_range_m = 0.05\nsigma_bearing_deg = 0.4\n")
    for name, lines in (("odometry", odometry), ("detections", detections), ("truth_poses", poses)):
        (folder / f"{name}.csv").write_text("\n".join(lines) + "\n")
    return helixnav.read_log(folder)


@pytest.fixture(scope="module")
def days(tmp_path_factory):
    """A run on the first log, its folder, and another log that begins elsewhere."""
    folder = tmp_path_factory.mktemp("days")
    monday = helixnav.replay(write_log(folder / "monday", 0, 260, 2), out=folder / "run")
    return monday, folder / "run", write_log(folder / "tuesday", 90, 300, 3)


def error_of(run):
    return run.evaluate()["error"]


def test_a_run_on_an_earlier_map_is_judged_in_the_frame_of_that_map(days, tmp_path):
    monday, folder, log = days
    assert error_of(monday)["rmse_m"] < 0.3
    place = turned_back(truth(0), truth(90)[None, :2])[0]
    starts = ("unknown", [*place, 90 * 0.5 / RADIUS])
    for start in starts:
        error = error_of(helixnav.replay(log, map=folder, start=start, out=tmp_path / "next", overwrite=True))
        assert not error["aligned"] and error["rmse_m"] < 0.3, start
        assert error == helixnav.evaluate(tmp_path / "next")["error"]
    error = error_of(helixnav.replay(log, map=folder, localize=True, start="unknown"))
    assert not error["aligned"] and error["rmse_m"] < 0.3


def test_on_a_map_that_does_not_know_the_frame_of_the_truth_the_truth_is_aligned_and_that_is_said(days, program, tmp_path):
    monday, folder, log = days
    run = helixnav.replay(log, map=monday.joint_map, out=tmp_path / "run")
    error = error_of(run)
    assert error["aligned"] and error["against"] == "poses" and error["rmse_m"] < 0.3
    assert "true poses, after rigid alignment" in program("evaluate", tmp_path / "run")


def test_a_third_day_in_the_map_of_the_second_is_judged_in_the_frame_of_the_first(days, tmp_path):
    _, folder, log = days
    helixnav.replay(log, map=folder, out=tmp_path / "second")
    error = error_of(helixnav.replay(log, map=tmp_path / "second"))
    assert not error["aligned"] and error["rmse_m"] < 0.3


def test_a_truth_that_is_given_in_another_room_is_not_passed_over_in_silence(days, program, tmp_path):
    _, folder, _ = days
    log = write_log(tmp_path / "elsewhere", 90, 300, 3, room=np.array([50.0, 10.0, 0.5]))
    error = error_of(helixnav.replay(log, map=folder, out=tmp_path / "run"))
    assert error["rmse_m"] > 10.0 and error["rmse_aligned_m"] < 0.3
    assert "map and truth lie apart" in program("evaluate", tmp_path / "run")
