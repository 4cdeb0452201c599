# SPDX-License-Identifier: BSD-3-Clause
import os
import subprocess

import pytest


@pytest.fixture(scope="session")
def program():
    """Runs the program; its standard output."""
    def run(*words, stdin=None):
        done = subprocess.run([os.environ["HELIXNAV_PROGRAM"], *map(str, words)], stdin=stdin, check=True,
                              stdout=subprocess.PIPE, text=True)
        return done.stdout
    return run


@pytest.fixture(scope="session")
def own_log(program, tmp_path_factory):
    """The example that new-vehicle writes."""
    folder = tmp_path_factory.mktemp("own") / "robot"
    program("new-vehicle", folder)
    return folder
