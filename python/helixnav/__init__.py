# SPDX-License-Identifier: BSD-3-Clause
"""HelixNav: landmark navigation with an exact compressed EKF.

    import helixnav

    log = helixnav.read_log("my_drive")              # or helixnav.simulate("large-loop", seed=1)
    run = helixnav.replay(log, out="runs/mine")      # same as helixnav replay, to the last digit
    print(run.explain(), run.evaluate()["nis"])

    navigator = helixnav.Navigator(log)              # or step by step
    for event in log.events:
        report = navigator.take(event)
    print(navigator.pose, navigator.map.means)

    stream = helixnav.Stream("vehicle.toml")         # or live, by times: scans may come late, rows need no splitting
    reports = stream.take({"odometry": {"t": 0.1, "v": 1.2, "omega_degps": 3}})

    tuesday = helixnav.replay(helixnav.read_log("tuesday"), map="runs/mine")      # continues in that map
    week = helixnav.join(["runs/robot_1", "runs/robot_2"], out="runs/week")       # one map from several
    slam = helixnav.FastSlam(options={"fastslam.particles": 200})                 # for comparison
    team = helixnav.Team(starts=[helixnav.Pose(), None])                          # several robots, live

Metres and radians, headings counter-clockwise, order (x, y, heading); times in seconds, or in whole nanoseconds as t_ns.
"""
from ._helixnav import (
    AbsoluteFix,
    Association,
    ChangedLandmark,
    Decision,
    FastSlam,
    FieldOfView,
    InputError,
    Joined,
    JoinedSession,
    JointMap,
    JudgedSighting,
    Log,
    Lost,
    Map,
    NamedNavigator,
    Navigator,
    NumericalError,
    NumericalHealth,
    Odometry,
    Pose,
    PreconditionError,
    RobotSighting,
    Run,
    SameLandmarks,
    Scan,
    StepReport,
    Stream,
    TakenBackJoin,
    Team,
    TeamJoin,
    TeamLog,
    TeamMember,
    TeamRun,
    __commit__,
    __version__,
    evaluate,
    join,
    read_log,
    read_map,
    read_run,
    read_team_log,
    replay,
    replay_team,
    simulate,
    simulate_team,
)

__all__ = [
    "AbsoluteFix",
    "Association",
    "ChangedLandmark",
    "Decision",
    "FastSlam",
    "FieldOfView",
    "InputError",
    "Joined",
    "JoinedSession",
    "JointMap",
    "JudgedSighting",
    "Log",
    "Lost",
    "Map",
    "NamedNavigator",
    "Navigator",
    "NumericalError",
    "NumericalHealth",
    "Odometry",
    "Pose",
    "PreconditionError",
    "RobotSighting",
    "Run",
    "SameLandmarks",
    "Scan",
    "StepReport",
    "Stream",
    "TakenBackJoin",
    "Team",
    "TeamJoin",
    "TeamLog",
    "TeamMember",
    "TeamRun",
    "evaluate",
    "join",
    "read_log",
    "read_map",
    "read_run",
    "read_team_log",
    "replay",
    "replay_team",
    "simulate",
    "simulate_team",
]

for _name in __all__:  # so that messages name this module, from which they are imported
    globals()[_name].__module__ = __name__
del _name
