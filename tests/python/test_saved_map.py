# SPDX-License-Identifier: BSD-3-Clause
"""A folder is of one map."""
import numpy as np
import pytest

import helixnav


def test_a_map_is_saved_beside_no_other_run(tmp_path):
    one = helixnav.replay(helixnav.simulate("circuit", 1), out=tmp_path / "run")
    other = helixnav.replay(helixnav.simulate("circuit", 2)).joint_map
    with pytest.raises(helixnav.InputError, match="not empty"):
        other.save(tmp_path / "run")
    assert np.array_equal(helixnav.read_map(tmp_path / "run").landmarks.means, one.joint_map.landmarks.means)
    other.save(tmp_path / "run", overwrite=True)
    assert np.array_equal(helixnav.read_map(tmp_path / "run").landmarks.means, other.landmarks.means)
    assert sorted(path.name for path in (tmp_path / "run").iterdir()) == ["drives.csv", "map.bin", "map.csv"]


def test_a_joined_map_is_written_beside_no_other_run(tmp_path):
    """And not over one of those that it is made of."""
    runs = [tmp_path / "one", tmp_path / "two"]
    for seed, run in enumerate(runs):
        helixnav.replay(helixnav.simulate("circuit", seed + 1), out=run)
    with pytest.raises(helixnav.InputError, match="is read"):
        helixnav.join(runs, out=runs[0], overwrite=True)
    helixnav.replay(helixnav.simulate("circuit", 3), out=tmp_path / "old")
    helixnav.join(runs, out=tmp_path / "old", overwrite=True)
    assert not (tmp_path / "old" / "manifest.json").exists() and not (tmp_path / "old" / "drive.bin").exists()
