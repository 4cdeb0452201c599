# SPDX-License-Identifier: BSD-3-Clause
"""HelixNav: landmark navigation with an exact compressed EKF.

    import helixnav

    log = helixnav.read_log("my_drive")              # or helixnav.simulate("large-loop", seed=1)
    run = helixnav.replay(log, out="runs/mine")      # as the program of the same name, to the last digit
    print(run.explain(), run.evaluate()["nis"])

    navigator = helixnav.Navigator(log)              # or step by step
    for event in log.events:
        report = navigator.take(event)
    print(navigator.pose, navigator.map.means)

Metres and radians, headings counter-clockwise, order (x, y, heading); times in seconds, or in whole nanoseconds as t_ns.
"""
from ._helixnav import (
    AbsoluteFix,
    Association,
    Decision,
    FieldOfView,
    InputError,
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
    Run,
    Scan,
    StepReport,
    __commit__,
    __version__,
    evaluate,
    read_log,
    read_run,
    replay,
    simulate,
)

__all__ = [
    "AbsoluteFix",
    "Association",
    "Decision",
    "FieldOfView",
    "InputError",
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
    "Run",
    "Scan",
    "StepReport",
    "evaluate",
    "read_log",
    "read_run",
    "replay",
    "simulate",
]

for _name in __all__:  # where they are imported from is where messages say they are
    globals()[_name].__module__ = __name__
del _name
