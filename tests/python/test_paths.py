# SPDX-License-Identifier: BSD-3-Clause
"""Folders whose names are no UTF-8, as on old disks."""
import os

import pytest

import helixnav


@pytest.mark.skipif(os.fsencode("\udcdf") != b"\xdf", reason="file names are no UTF-8 here")
def test_a_folder_whose_name_is_no_utf8(program, tmp_path):
    folder = os.path.join(os.fsencode(tmp_path), b"Stra\xdfe")
    program("new-vehicle", tmp_path / "street")
    os.rename(tmp_path / "street", folder)
    for read in (helixnav.read_log, helixnav.read_map, helixnav.read_run, helixnav.Stream):
        with pytest.raises(helixnav.InputError) as told:
            read(folder + b"/nothing")
        assert "Stra\udcdfe/nothing" in str(told.value)
    log = helixnav.read_log(folder)
    assert log.name == "Stra\udcdfe"
    run = helixnav.replay(log, out=folder + b"/out")
    assert os.fsencode(run.path) == folder + b"/out"
    assert run.evaluate() and run.explain()
    assert len(helixnav.replay(log, map=folder + b"/out", start="end")) >= len(run)
