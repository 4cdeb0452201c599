# SPDX-License-Identifier: BSD-3-Clause
"""Earlier maps, FastSLAM, joined runs and teams: as the program, to the last digit, and the errors of each."""
import json
import shutil

import numpy as np
import pytest

import helixnav

TABLES = ("trajectory.tum", "map.csv", "associations.csv", "decisions.csv")


def same(one, other, names=TABLES):
    for name in names:
        assert (one / name).read_bytes() == (other / name).read_bytes(), name


@pytest.fixture(scope="module")
def first(program, own_log, tmp_path_factory):
    """The example's log, navigated by the program."""
    folder = tmp_path_factory.mktemp("first") / "run"
    program("replay", own_log, "--out", folder, "--quiet")
    return folder


@pytest.fixture(scope="module")
def log(own_log):
    return helixnav.read_log(own_log)


@pytest.mark.parametrize("start, word", ((None, "unknown"), ("end", "end"), ([0.1, 0.0, 0.0], "0.1,0,0")))
def test_a_session_goes_on_in_an_earlier_map_as_the_program_does(program, own_log, log, first, tmp_path, start, word):
    program("replay", own_log, "--map", first, "--start", word, "--out", tmp_path / "program", "--quiet")
    run = helixnav.replay(log, out=tmp_path / "python", map=first, start=start)
    same(tmp_path / "program", tmp_path / "python", (*TABLES, "map.bin"))
    if start == "end":  # of a folder, what it was fed is driven again, and the log holds no more than that
        same(first, tmp_path / "python", (*TABLES, "map.bin", "drive.bin"))
        return
    from_value = helixnav.replay(log, map=helixnav.read_map(first), start=start)
    assert np.array_equal(from_value.trajectory, run.trajectory)
    assert np.array_equal(from_value.map.ids, run.map.ids)


def test_a_run_localizes_in_a_map_as_the_program_does(program, own_log, log, first, tmp_path):
    program("replay", own_log, "--map", first, "--localize", "--out", tmp_path / "program", "--quiet")
    run = helixnav.replay(log, out=tmp_path / "python", map=first / "map.csv", localize=True)
    same(tmp_path / "program", tmp_path / "python", ("trajectory.tum", "associations.csv"))
    assert run.joint_map is None and run.map.states == ["mature"] * len(run.map)


def test_smoothing_and_blackouts_are_those_of_the_program(program, own_log, log, tmp_path):
    program("replay", own_log, "--smooth", "--out", tmp_path / "smooth", "--quiet")
    run = helixnav.replay(log, out=tmp_path / "smooth_here", smooth=True)
    same(tmp_path / "smooth", tmp_path / "smooth_here", ("trajectory.tum", "trajectory_final.tum"))
    assert run.numbers["chi2"] > 0.0 and run.final_trajectory.shape == run.trajectory.shape
    program("replay", own_log, "--blackout", "10:20", "--out", tmp_path / "blind", "--quiet")
    helixnav.replay(helixnav.read_log(own_log, blackouts=[(10, 20)]), out=tmp_path / "blind_here")
    same(tmp_path / "blind", tmp_path / "blind_here")


def test_fastslam_is_that_of_the_program(program, own_log, tmp_path):
    options = {"filter.method": "fastslam", "fastslam.particles": 30, "fastslam.seed": 7}
    program("replay", own_log, *(f"--{key}={value}" for key, value in options.items()), "--out", tmp_path / "program",
            "--quiet")
    log = helixnav.read_log(own_log, options=options)
    run = helixnav.replay(log, out=tmp_path / "python")
    same(tmp_path / "program", tmp_path / "python", ("trajectory.tum", "map.csv", "associations.csv"))
    slam = helixnav.FastSlam(log)
    poses = [report.pose.mean for report in map(slam.take, log.events) if report is not None]
    np.testing.assert_allclose(np.array(poses), run.trajectory[:, 1:], atol=1e-12)
    assert slam.particles.shape == (30, 3) and slam.weights.sum() == pytest.approx(1.0)
    assert np.array_equal(slam.map.means, run.map.means) and slam.pose.x == pytest.approx(poses[-1][0], abs=1.0)
    with pytest.raises(helixnav.InputError, match="fastslam"):
        helixnav.read_log(own_log, options={"fastslam.particles": 30})
    with pytest.raises(helixnav.InputError, match="search.particles"):
        helixnav.FastSlam(options={"search.particles": 300})


def test_fastslam_by_names():
    slam = helixnav.FastSlam(options={"fastslam.association": "known", "fastslam.particles": 10})
    scan = helixnav.Scan(0.0, "cartesian", [[5.0, 1.0], [6.0, -2.0]], 0.01 * np.eye(2))
    slam.move(helixnav.Odometry(0.0, [0.1, 0.0, 0.0], 1e-4 * np.eye(3)))
    assert slam.observe(scan, [7, 9]).associations[0].outcome == "augmented"
    assert slam.observe(scan, [9, 7]).associations[0].landmark == slam.map.ids[1]
    with pytest.raises(helixnav.PreconditionError):
        slam.observe(scan)
    with pytest.raises(helixnav.PreconditionError, match="Odometry and Scan"):
        slam.take(helixnav.Lost(1.0))


def test_navigators_go_on_in_a_joint_map(log):
    navigator = helixnav.Navigator(log)
    for event in log.events:
        navigator.take(event)
    earlier = navigator.joint_map(reach=12.0)
    assert earlier.reach == 12.0 and len(earlier) == len(navigator.map)
    assert earlier.covariance.shape == (3 + 2 * len(earlier),) * 2
    assert np.array_equal(earlier.landmarks.means, navigator.map.means)
    later = helixnav.Navigator.go_on_in(earlier)
    off = later.pose.mean - navigator.pose.mean  # the drive is solved, not linearised once
    assert off @ np.linalg.solve(navigator.pose.covariance, off) < 0.01
    np.testing.assert_allclose(later.pose.covariance, navigator.pose.covariance, rtol=0.1, atol=1e-6)
    assert np.array_equal(later.map.ids, navigator.map.ids)
    seeker = helixnav.Navigator(log)
    seeker.look_for_place_in(earlier)
    assert list(seeker.maps_apart) == [0]
    named = helixnav.NamedNavigator.go_on_in(earlier, {4: int(earlier.landmarks.ids[0])})
    assert len(named.map) == len(earlier)
    with pytest.raises(helixnav.PreconditionError):
        navigator.look_for_place_in(earlier)  # it has scans already
    with pytest.raises(helixnav.PreconditionError):
        navigator.joint_map(reach=-1.0)


@pytest.mark.parametrize("wishes, why", (
    (dict(start="end"), "give map"),
    (dict(localize=True), "needs a map"),
    (dict(map="here", smooth=True), "smooth takes no map"),
    (dict(map="here", localize=True, start="end"), "goes on mapping"),
    (dict(map="here", start="begin"), "expected 'unknown'"),
    (dict(map="here", start=[0.0, 0.0]), r"shape \(3,\)"),
    (dict(map="here", start=[0.0, np.nan, 0.0]), "not finite"),
))
def test_wishes_that_exclude_each_other_are_refused(log, wishes, why):
    with pytest.raises(helixnav.PreconditionError, match=why):
        helixnav.replay(log, **wishes)


def test_a_map_that_is_not_there_is_said(log, tmp_path):
    with pytest.raises(helixnav.InputError, match="expected the folder of a run"):
        helixnav.replay(log, map=tmp_path / "nowhere")
    with pytest.raises(helixnav.InputError, match="expected a map.csv"):
        helixnav.replay(log, map=tmp_path / "nowhere", localize=True)
    with pytest.raises(TypeError):
        helixnav.replay(log, map=3)
    with pytest.raises(TypeError, match="sessions: expected a path or a JointMap, found int"):
        helixnav.join([1, 2])


def another_day(own_log, tmp_path):
    """The same way again: other noise in its ranges."""
    folder = tmp_path / "another_day"
    shutil.copytree(own_log, folder)
    header, *rows = (folder / "detections.csv").read_text().splitlines()
    column = header.split(",").index("range_m")
    noise = np.random.default_rng(2).normal(0.0, 0.01, len(rows))
    for k, row in enumerate(rows):
        cells = row.split(",")
        if cells[column]:
            cells[column] = f"{float(cells[column]) + noise[k]:.4f}"
        rows[k] = ",".join(cells)
    (folder / "detections.csv").write_text("\n".join([header, *rows]) + "\n")
    return folder


def test_runs_are_joined_as_the_program_joins_them(program, own_log, first, tmp_path):
    other = tmp_path / "other"
    helixnav.replay(helixnav.read_log(another_day(own_log, tmp_path)), out=tmp_path / "a")
    program("simulate", "circuit", "--seed", 1, "--out", tmp_path / "b", "--quiet")
    program("join", first, tmp_path / "a", tmp_path / "b", "--out", other, "--quiet")
    joined = helixnav.join([first, tmp_path / "a", tmp_path / "b"], out=tmp_path / "here")
    same(other, tmp_path / "here", ("map.csv", "map.bin", "joins.csv", "changes.csv"))
    assert len(joined.sessions) == 3 and joined.sessions[0].component == joined.sessions[1].component
    assert len(joined.components) == 2 and joined.sessions[2].component == 1
    assert {session.decision.verdict for session in joined.sessions if session.decision} >= {"accepted"}
    assert joined.changes and {landmark.change for landmark in joined.changes} <= {"kept", "gone", "new", "both", "moved"}
    again = helixnav.join([helixnav.read_map(folder) for folder in (first, tmp_path / "a")])
    assert len(again.components) == 1
    again.components[0].save(tmp_path / "saved")
    assert len(helixnav.read_map(tmp_path / "saved")) == len(again.components[0])
    with pytest.raises(helixnav.InputError, match="the same map as"):
        helixnav.join([first, first])
    with pytest.raises(helixnav.InputError, match="not empty"):
        helixnav.join([tmp_path / "a", tmp_path / "b"], out=tmp_path / "here")
    with pytest.raises(helixnav.PreconditionError, match="two sessions"):
        helixnav.join([first])


def test_a_run_that_went_on_is_not_joined_with_what_it_went_on_in(log, first, tmp_path):
    helixnav.replay(log, out=tmp_path / "later", map=first)
    with pytest.raises(helixnav.InputError, match="holds it already"):
        helixnav.join([first, tmp_path / "later"])


def test_a_joined_map_is_not_joined_with_what_it_is_made_of(log, own_log, first, tmp_path):
    helixnav.replay(helixnav.read_log(another_day(own_log, tmp_path)), out=tmp_path / "a")
    helixnav.join([first, tmp_path / "a"], out=tmp_path / "joined")
    with pytest.raises(helixnav.InputError, match="was joined from the map of"):
        helixnav.join([tmp_path / "joined", first])
    helixnav.replay(log, out=tmp_path / "later", map=first)
    with pytest.raises(helixnav.InputError, match="both hold the map of"):
        helixnav.join([tmp_path / "later", tmp_path / "joined"])


@pytest.fixture(scope="module")
def team_log():
    return helixnav.simulate_team(robots=2, seed=1)


def test_a_team_is_navigated_as_the_program_does(program, team_log, tmp_path):
    program("simulate", "team", "--seed", 1, "--unknown-starts", "--out", tmp_path / "program", "--quiet")
    run = helixnav.replay_team(team_log, out=tmp_path / "python", unknown_starts=True)
    same(tmp_path / "program", tmp_path / "python", ("map.csv", "joins.csv", "sightings.csv"))
    same(tmp_path / "program" / "robot_1", tmp_path / "python" / "robot_1", ("trajectory.tum",))
    told = json.loads((tmp_path / "program" / "summary.json").read_text())
    mine = run.evaluate()
    told.pop("timing"), mine.pop("timing")
    assert mine == told and len(run) == 2 and run.component(1) == run.component(0) == 0
    assert run.joins and run.joins[0].by in ("names", "sightings") and run.joins[0].cost <= run.joins[0].limit
    assert len(run.trajectory(1)) == len(run.steps(1)) > 10 and len(run.map(0)) > 10 and "robot" in run.explain()
    with pytest.raises(IndexError):
        run.map(2)


def feed(team, team_log):
    fed = []
    for index, robot in enumerate(team_log.robots):
        scans = iter(robot.labels)
        for event in robot.events:
            is_scan = isinstance(event, helixnav.Scan)
            fed.append((event.t_ns, 2 if is_scan else 0, index, event, next(scans) if is_scan else ()))
        fed += [(sighting.t_ns, 1, index, sighting, None) for sighting in robot.sightings]
    for _, kind, index, event, names in sorted(fed, key=lambda row: row[:3]):
        if kind == 1:
            team.sight(index, event)
        else:
            assert (team.take(index, event, names) is not None) == (kind == 2)


def test_a_team_takes_events_live(team_log):
    team = helixnav.Team([None, None])
    feed(team, team_log)
    team.solve()
    assert team.component(1) == 0 and len(team.joins) == 1 and any(sighting.used for sighting in team.sightings)
    name = next(label for labels in team_log.robots[0].labels for label in labels if label >= 0)
    assert team.landmark_of(0, name) in team.map(0).ids and team.landmark_of(0, 10**6) is None
    assert team.path(0).shape[1] == 4 and np.isfinite(team.pose(1).mean).all()
    taken_back = team.joins[0].by
    team.remove_join(0)
    assert taken_back not in [join.by for join in team.joins]
    for wrong in (lambda: team.pose(2), lambda: team.sight(0, helixnav.RobotSighting(0.0, 7, "cartesian", [1, 1], np.eye(2)))):
        with pytest.raises(helixnav.PreconditionError):
            wrong()
    for wrong in (lambda: helixnav.RobotSighting(0.0, 1, "range", [1.0], np.eye(1)),
                  lambda: helixnav.RobotSighting(0.0, 1, "cartesian", [[1, 1], [2, 2]], np.eye(2))):
        with pytest.raises(helixnav.PreconditionError):
            wrong()


def test_landmarks_that_were_made_one_are_listed_and_taken_back(team_log):
    team = helixnav.Team([None, None], by_names=False, by_place=True)
    feed(team, team_log)
    team.solve()
    same = team.same_landmarks
    assert same and all(one.cost <= one.limit and one.nats > 0 and one.kept != one.removed for one in same)
    removed = same[0].removed
    team.remove_same(0)
    assert (same[0].kept, removed) not in [(one.kept, one.removed) for one in team.same_landmarks]
    with pytest.raises(helixnav.PreconditionError):
        team.remove_same(len(team.same_landmarks))


def test_a_team_without_names_is_that_of_the_program(program, tmp_path):
    helixnav.replay_team(helixnav.simulate_team(robots=3, seed=7), out=tmp_path / "python", known_association=False)
    program("simulate", "team", "--robots", 3, "--seed", 7, "--association", "unknown", "--out", tmp_path / "program",
            "--quiet")
    same(tmp_path / "python", tmp_path / "program", ("map.csv", "joins.csv"))


def test_the_noise_of_a_team_log_is_an_option(tmp_path):
    (tmp_path / "odometry.csv").write_text("1,0.0,0.2,0.0\n1,1.0,0.2,0.0\n1,2.0,0.0,0.0\n")
    (tmp_path / "measurements.csv").write_text("1,0.53,63,6,2.0,0.1\n1,1.27,63,6,1.9,0.1\n")
    (tmp_path / "landmarks_true.csv").write_text("6,2.0,0.1,0.0,0.0\n")

    def variance(options):
        log = helixnav.read_team_log(tmp_path, options=options)
        return next(e for e in log.robots[0].events if isinstance(e, helixnav.Scan) and len(e)).R[0, 0, 0]

    assert variance({"mrclam": {"sigma_range_m": 0.4}}) == pytest.approx(16.0 * variance({"mrclam.sigma_range_m": 0.1}))
    with pytest.raises(helixnav.InputError, match="several robots"):
        helixnav.read_team_log(tmp_path, options={"search.particles": 300})
