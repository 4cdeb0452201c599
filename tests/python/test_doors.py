# SPDX-License-Identifier: BSD-3-Clause
"""What is refused where it comes in, and what is said then."""
import numpy as np
import pytest

import helixnav

D = np.diag([1e-4, 1e-5, 1e-5])


@pytest.mark.parametrize("options, why", [
    ({"filter.method": "fastslam"}, "a stream is navigated by the compressed EKF"),
    ({"fastslam.particles": 7}, "fastslam"),
    ({"gps.use": "fuse"}, "a stream uses no fixes"),
])
def test_a_stream_refuses_what_the_program_refuses(own_log, options, why):
    with pytest.raises(helixnav.InputError, match=why):
        helixnav.Stream(own_log / "vehicle.toml", options)


def test_a_team_refuses_what_it_has_no_use_for():
    team = helixnav.Team([helixnav.Pose(), None])
    team.take(0, helixnav.Odometry(0, (1, 0, 0), D))
    with pytest.raises(helixnav.PreconditionError, match="position fixes"):
        team.take(0, helixnav.AbsoluteFix(5, (100, 100), np.eye(2)))
    with pytest.raises(helixnav.PreconditionError, match="sees itself"):
        team.sight(0, helixnav.RobotSighting(0, 0, "cartesian", (1, 2), np.eye(2)))
    assert not team.sightings
    for looks in (-1, 0, 0.5, float("nan"), float("inf")):
        with pytest.raises(helixnav.PreconditionError, match="looks_as_one"):
            helixnav.Team([None], looks_as_one=looks)


def test_joins_of_a_team_tell_what_they_left_out_and_whether_they_were_taken_back():
    run = helixnav.replay_team(helixnav.simulate_team(2, 1), unknown_starts=True)
    assert run.joins and run.joins_taken_back == [] and run.joins[0].left_out >= 0
    team = helixnav.Team([None, None])
    log = helixnav.simulate_team(2, 1)
    events = sorted(((event.t_ns, robot, k, names) for robot, member in enumerate(log.robots)
                     for k, (event, names) in enumerate(named(member))), key=lambda one: one[:3])
    kept = [member.events for member in log.robots]
    for _, robot, k, names in events:
        team.take(robot, kept[robot][k], names)
    team.solve()
    team.remove_join(0)
    assert not team.joins
    back = team.joins_taken_back
    assert len(back) == 1 and back[0].seen == 0 and back[0].join.by == "names"


def named(member):
    """Events with the names of each scan."""
    scans = iter(member.labels)
    return [(event, next(scans) if isinstance(event, helixnav.Scan) else ()) for event in member.events]


def test_half_a_surrogate_pair_is_no_text(own_log):
    with pytest.raises(ValueError, match="classes"):
        helixnav.Scan(0.0, "cartesian", [[1, 2]], np.eye(2), classes=["cone\ud800"])
    stream = helixnav.Stream(own_log / "vehicle.toml")
    with pytest.raises(ValueError, match="line"):
        stream.take('{"odometry": {"t": 0, "\ud800": 1}}')
    stream.take({"odometry": {"t": 0, "\ud800": 1}})
    assert len(stream.take_refused()) == 1


def test_a_stream_takes_the_scalars_of_numpy(own_log):
    plain, numpy = (helixnav.Stream(own_log / "vehicle.toml") for _ in range(2))
    for k in range(20):
        row = {"t_ns": 100_000_000 * k, "v": 1.5, "omega_degps": 3}
        plain.take({"odometry": row})
        numpy.take({"odometry": {"t_ns": np.int64(row["t_ns"]), "v": np.float32(1.5), "omega_degps": np.uint8(3)}})
        seen = {"t_ns": row["t_ns"], "x": 4.0, "y": 1.0}
        plain.take({"detections": [seen]})
        numpy.take({"detections": [{"t_ns": np.int64(seen["t_ns"]), "x": np.float32(4.0), "y": np.int16(1)}]})
    a, b = plain.finish(), numpy.finish()
    assert plain.take_refused() == numpy.take_refused()
    assert len(a) == len(b) and np.array_equal(plain.map.means, numpy.map.means)
    with pytest.raises(TypeError, match="complex"):
        numpy.take({"odometry": {"t": 1j}})
