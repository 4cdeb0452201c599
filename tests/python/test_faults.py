# SPDX-License-Identifier: BSD-3-Clause
"""What nonsense, signals and wrong options come to."""
import signal
import subprocess
import sys

import numpy as np
import pytest

import helixnav

EYE3 = np.eye(3)
VIEW = helixnav.FieldOfView(max_range=20.0)


def scan(t=0.0, z=((3.0, 0.0), (5.0, 1.0), (7.0, -1.0)), **options):
    return helixnav.Scan(t, "range_bearing", np.array(z), np.diag([0.01, 1e-4]), view=VIEW, **options)


@pytest.mark.parametrize("made", [
    lambda: scan(mounting=[1e160, 0, 0]),
    lambda: scan(z=[[1e100, 0]]),
    lambda: helixnav.Scan(0.0, "cartesian", [[1e160, 0]], 0.01 * np.eye(2)),
    lambda: helixnav.Scan(0.0, "range_bearing", [[3.0, 0]], 1e150 * np.eye(2)),
    lambda: helixnav.Odometry(0.0, [1e100, 0, 0], 1e-4 * EYE3),
    lambda: helixnav.Odometry(0.0, [0, 0, 0], 1e100 * EYE3),
    lambda: helixnav.AbsoluteFix(0.0, [1e9, 0], np.eye(2)),
    lambda: helixnav.Pose((1e9, 0, 0)),
    lambda: helixnav.Pose((0, 0, 0), np.diag([1e17, 1, 1])),
    lambda: helixnav.Navigator().joint_map(reach=1e6),
    lambda: helixnav.Navigator().joint_map(reach=float("inf")),
])
def test_what_is_beyond_any_vehicle_is_refused(made):
    with pytest.raises(helixnav.PreconditionError):
        made()


def test_a_mounting_far_beyond_the_vehicle_hangs_nothing():
    navigator = helixnav.Navigator()
    for k in range(6):
        navigator.move(helixnav.Odometry(0.1 * k, [0.1, 0, 0], 1e-4 * EYE3))
        navigator.observe(scan(0.1 * k, mounting=[9e7 if k == 2 else 0.0, 0, 0]))


@pytest.mark.parametrize("options, named", [
    ({"filter.method": "fastslam"}, "FastSlam"), ({"association.method": "known"}, "NamedNavigator"),
    ({"log.max_range_m": 3}, "log.max_range_m"), ({"log": {"covariance_scale": 4}}, "log.covariance_scale"),
    ({"gps.use": "fuse"}, "gps.use"), ({"victoria_park.sigma_range_m": 3}, "victoria_park.sigma_range_m")])
def test_options_that_a_navigator_cannot_heed_are_refused(options, named):
    with pytest.raises(helixnav.InputError, match=named):
        helixnav.Navigator(options=options)


def test_options_of_any_fix_and_of_names_are_heeded():
    helixnav.Navigator(options={"gps.gate_probability": 0.9})
    helixnav.NamedNavigator(options={"association.method": "known"})
    with pytest.raises(helixnav.InputError, match="log.view_deg"):
        helixnav.FastSlam(options={"log.view_deg": 60})


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


def test_names_wrong_changes_what_a_named_navigator_does():
    default = end_of({}, 0.05, 1)
    assert not np.array_equal(default, end_of({"names.wrong": 0}, 0.05, 1))
    assert np.array_equal(default, end_of({"names.wrong": 0.001}, 0.05, 1))


def test_fastslam_takes_a_negative_identity_for_no_landmark():
    slam = helixnav.FastSlam(options={"fastslam.association": "known"})
    report = slam.observe(scan(), [-1, 4, -3])
    assert [a.outcome for a in report.associations] == ["rejected", "augmented", "rejected"]
    assert len(slam.map) == 1


def test_identities_beyond_64_bits_with_sign_are_refused():
    for ids in (np.array([2**63 + 5, 7, 8], np.uint64), [2**63 + 5, 7, 8]):
        with pytest.raises((helixnav.PreconditionError, TypeError)):
            helixnav.NamedNavigator().observe(scan(), ids)
    helixnav.NamedNavigator().observe(scan(), np.array([2**63 - 1, 7, 8], np.uint64))


def test_classes_are_names():
    with pytest.raises(TypeError, match="classes"):
        scan(classes=[1, None, "oak"])


def test_new_without_init_makes_nothing():
    for name in helixnav.__all__:
        made = getattr(helixnav, name)
        if isinstance(made, type) and not issubclass(made, BaseException):
            with pytest.raises(TypeError):
                made.__new__(made)


def test_classes_of_the_module_can_be_derived_from():
    class Mine(helixnav.Navigator):
        def __init__(self):
            super().__init__()
            self.scans = 0

    mine = Mine()
    mine.observe(scan())
    assert mine.scans == 0 and len(mine.map) == 3


def test_every_property_is_explained():
    for name in helixnav.__all__:
        made = getattr(helixnav, name)
        if not isinstance(made, type) or issubclass(made, BaseException):
            continue
        for key, value in vars(made).items():
            if isinstance(value, property):
                assert (value.__doc__ or "").strip(), f"{name}.{key}"


REPLAY = """
import sys, helixnav
log = helixnav.simulate("town", seed=1, options={options})
print("begun", flush=True)
try:
    helixnav.replay(log, out=sys.argv[1])
except KeyboardInterrupt:
    print("interrupted", flush=True)
"""


def interrupted(code, *words, after_s):
    child = subprocess.Popen([sys.executable, "-c", code, *map(str, words)], stdout=subprocess.PIPE, text=True)
    assert child.stdout.readline() == "begun\n"
    try:
        child.wait(timeout=after_s)
    except subprocess.TimeoutExpired:
        child.send_signal(signal.SIGINT)
    return child.communicate(timeout=60)[0]


def test_ctrl_c_leaves_a_whole_run_folder(tmp_path):
    assert interrupted(REPLAY.replace("{options}", "{}"), tmp_path / "run", after_s=0.7) == "interrupted\n"
    for name in ("map.csv", "map.bin", "summary.json", "report.html", "drive.bin"):
        assert (tmp_path / "run" / name).exists(), name
    run = helixnav.read_run(tmp_path / "run")
    assert 0 < len(run) and len(helixnav.read_map(tmp_path / "run")) > 0


def test_ctrl_c_ends_join_before_it_writes(tmp_path):
    code = """
import sys, helixnav
drives = [helixnav.replay(helixnav.simulate("large-loop", seed=k)).joint_map for k in range(1, 9)]
print("begun", flush=True)
try:
    helixnav.join(drives, out=sys.argv[1])
except KeyboardInterrupt:
    print("interrupted", flush=True)
"""
    assert interrupted(code, tmp_path / "out", after_s=0.1) == "interrupted\n"
    assert not (tmp_path / "out").exists()


def test_ctrl_c_ends_a_team_before_it_writes(tmp_path):
    code = """
import sys, helixnav
log = helixnav.simulate_team(robots=12, seed=1)
print("begun", flush=True)
try:
    helixnav.replay_team(log, out=sys.argv[1], known_association=False)
except KeyboardInterrupt:
    print("interrupted", flush=True)
"""
    assert interrupted(code, tmp_path / "out", after_s=0.1) == "interrupted\n"
    assert not (tmp_path / "out").exists()


def test_a_team_has_a_robot():
    with pytest.raises(helixnav.PreconditionError, match="one robot"):
        helixnav.Team([])
