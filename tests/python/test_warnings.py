# SPDX-License-Identifier: BSD-3-Clause
"""What is not well is said as the program says it."""
import os
import shutil
import subprocess

import helixnav


def test_a_sensor_that_looks_aside_is_said_as_by_the_program(own_log, tmp_path):
    assert helixnav.replay(helixnav.read_log(own_log)).warnings() == []
    log = shutil.copytree(own_log, tmp_path / "aside")
    vehicle = log / "vehicle.toml"
    vehicle.write_text(vehicle.read_text().replace("heading_deg = 0.0", "heading_deg = 3.0"))
    run = helixnav.replay(helixnav.read_log(log), out=tmp_path / "python")
    assert any(decision.kind == "systematic" for step in run.steps for decision in step.decisions)
    done = subprocess.run([os.environ["HELIXNAV_PROGRAM"], "replay", log, "--out", tmp_path / "program", "--quiet"],
                          check=True, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
    said = [line.removeprefix("helixnav: warning: ") for line in done.stderr.splitlines() if "warning" in line]
    assert run.warnings() == said and any("deg farther to the right than heading_deg says" in text for text in said)
