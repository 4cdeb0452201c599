# SPDX-License-Identifier: BSD-3-Clause
"""What one drive saw is counted once, whichever way its maps come to join."""
import numpy as np
import pytest

import helixnav

REACH = 15.0


def drive(navigator, seed, laps=1.0, world=1):
    """Round a circle in one world of trees."""
    random = np.random.default_rng(seed)
    trees = np.random.default_rng(world).uniform(-34.0, 34.0, (60, 2))
    view = helixnav.FieldOfView(max_range=REACH)
    for k in range(int(laps * 250)):
        angle = 0.5 * k / 20.0
        if k > 0:
            noise = random.normal(0.0, [0.01, 0.01, 0.002])
            navigator.move(helixnav.Odometry(k, np.array([0.5, 0.00625, 0.025]) + noise, np.diag([1e-4, 1e-4, 4e-6])))
        c, s = np.cos(angle + 0.5 * np.pi), np.sin(angle + 0.5 * np.pi)
        seen = (trees - 20.0 * np.array([np.cos(angle), np.sin(angle)])) @ np.array([[c, -s], [s, c]])
        seen = seen[np.hypot(*seen.T) < REACH] + random.normal(0.0, 0.05, (np.sum(np.hypot(*seen.T) < REACH), 2))
        navigator.observe(helixnav.Scan(k, "cartesian", seen, 0.0025 * np.eye(2), view=view))
    return navigator


@pytest.fixture(scope="module")
def days():
    monday, tuesday = drive(helixnav.Navigator(), 2), drive(helixnav.Navigator(), 3)
    return monday, tuesday


def test_independent_drives_are_joined_and_the_joined_map_knows_both(days, tmp_path):
    a, b = (day.joint_map(REACH) for day in days)
    assert len(a.drives) == len(b.drives) == 1 and a.drives != b.drives
    joined = helixnav.join([a, b], out=tmp_path / "both")
    assert len(joined.components) == 1
    assert joined.components[0].drives == sorted(a.drives + b.drives)
    assert helixnav.read_map(tmp_path / "both").drives == joined.components[0].drives


def test_what_one_drive_saw_is_not_joined_with_itself(days, tmp_path, program):
    monday, tuesday = days
    a, b = monday.joint_map(REACH), tuesday.joint_map(REACH)
    a.save(tmp_path / "a")
    a.save(tmp_path / "copy")
    joined = helixnav.join([a, b]).components[0]
    joined.save(tmp_path / "both")
    went_on = helixnav.Navigator()
    went_on.look_for_place_in(a)
    drive(went_on, 4)
    assert not went_on.maps_apart
    in_a = went_on.joint_map(REACH)
    in_a.save(tmp_path / "in_a")
    shorter = drive(helixnav.Navigator(), 2, laps=0.8).joint_map(REACH)
    twice = [[a, a], [a, monday.joint_map(REACH)], [a, in_a], [joined, b], [a, shorter],
             [tmp_path / "a", tmp_path / "copy"], [tmp_path / "a", tmp_path / "in_a"], [tmp_path / "both", b],
             [tmp_path / "both", tmp_path / "a"]]
    for maps in twice:
        with pytest.raises(helixnav.InputError, match="one drive saw|same map"):
            helixnav.join(maps)
    with pytest.raises(Exception):
        program("join", tmp_path / "a", tmp_path / "in_a", "--out", tmp_path / "cli")


def test_a_session_that_is_not_on_the_earlier_map_holds_nothing_of_it(days):
    a = days[0].joint_map(REACH)
    looking = helixnav.Navigator()
    looking.look_for_place_in(a)
    drive(looking, 5, laps=0.2, world=9)
    own = looking.joint_map(REACH).drives
    assert 0 in looking.maps_apart and own and own != a.drives and len(own) == 1
    assert looking.maps_apart[0].drives == a.drives


def test_runs_of_a_log_know_their_drive(tmp_path):
    log = helixnav.simulate("large-loop", seed=3)
    run = helixnav.replay(log, out=tmp_path / "run")
    other = helixnav.replay(log, out=tmp_path / "other", map=tmp_path / "run")
    assert run.joint_map.drives == helixnav.read_map(tmp_path / "run").drives and len(run.joint_map.drives) == 1
    assert other.joint_map.drives == run.joint_map.drives
    with pytest.raises(helixnav.InputError):
        helixnav.join([run.joint_map, tmp_path / "other"])
