# SPDX-License-Identifier: BSD-3-Clause
"""A joined map is made of sessions that ended elsewhere each."""
import numpy as np
import pytest

import helixnav
from test_join_once import REACH, drive


@pytest.fixture(scope="module")
def joined():
    maps = [drive(helixnav.Navigator(), seed).joint_map(REACH) for seed in (2, 3)]
    return helixnav.join(maps)


def test_nobody_goes_on_from_the_end_of_a_joined_map(joined, tmp_path):
    component = joined.components[0]
    component.save(tmp_path / "saved")
    log = helixnav.simulate("circuit", 1)
    for given in (component, tmp_path / "saved", helixnav.read_map(tmp_path / "saved")):
        with pytest.raises(ValueError, match="a joined map has no end"):
            helixnav.replay(log, map=given, start="end")
    with pytest.raises(ValueError, match="a joined map has no end"):
        helixnav.Navigator.go_on_in(component)
    with pytest.raises(ValueError, match="a joined map has no end"):
        helixnav.NamedNavigator.go_on_in(component, {})


def test_a_pose_on_it_is_gone_on_from(joined):
    run = helixnav.replay(helixnav.simulate("circuit", 1), map=joined.components[0], start=(0.0, 0.0, 0.0))
    assert len(run) > 0
    went_on = helixnav.Navigator.go_on_in(run.joint_map)
    assert len(went_on.map) > 0


def test_of_sessions_it_is_told_how_they_were_placed(joined):
    placed = [session.decision for session in joined.sessions]
    asked = [decision for decision in placed if decision is not None]
    assert len(asked) == 1 and asked[0].verdict == "accepted"
    sentence = asked[0].sentence
    assert sentence.startswith("Found its place (") and "0 m" not in sentence.split(":")[0]
    assert "of the best question agree with the map" in sentence and " of 0 " not in sentence
    assert sentence in repr(asked[0])
