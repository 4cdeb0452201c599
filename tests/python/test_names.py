# SPDX-License-Identifier: BSD-3-Clause
"""What a log calls its landmarks."""
import helixnav


def test_a_run_by_names_has_them_in_its_map(program, tmp_path):
    log = tmp_path / "log"
    log.mkdir()
    (log / "vehicle.toml").write_text(
        "[odometry]\nsigma_along_m_per_sqrt_m = 0.02\nsigma_sideways_m_per_sqrt_m = 0.01\n"
        "sigma_heading_deg_per_sqrt_m = 0.3\n[[sensor]]\nreach_m = 15\nview_deg = [-180, 180]\nsigma_point_m = 0.05\n")
    (log / "odometry.csv").write_text("t,dx,dheading\n" + "".join(f"{k*.1},0.1,0\n" for k in range(60)))
    (log / "detections.csv").write_text("t,x,y,id\n" + "".join(
        f"{k*.1},{5-.1*k},3,church\n{k*.1},{6-.1*k},-3,north pier\n" for k in range(60)))
    program("replay", log, "--association", "known", "--out", tmp_path / "program", "--quiet")
    known = helixnav.read_log(log, options={"association.method": "known"})
    helixnav.replay(known, out=tmp_path / "python")
    table = (tmp_path / "python" / "map.csv").read_text()
    assert table == (tmp_path / "program" / "map.csv").read_text() and "north pier" in table
    (log / "detections.csv").write_text("t,x,y,id\n" + "".join(  # north pier is the first name of this log
        f"{k*.1},{6-.1*k},-3,north pier\n{k*.1},{5-.1*k},3,church\n" for k in range(60)))
    again = helixnav.read_log(log, options={"association.method": "known"})
    program("replay", log, "--association", "known", "--map", tmp_path / "program", "--start", "0,0,0", "--out",
            tmp_path / "program2", "--quiet")
    helixnav.replay(again, map=tmp_path / "python", start=(0, 0, 0), out=tmp_path / "python2")
    assert (tmp_path / "python2" / "map.csv").read_text() == (tmp_path / "program2" / "map.csv").read_text()


def test_joined_runs_keep_them_as_by_the_program(program, tmp_path):
    days = [tmp_path / "monday", tmp_path / "tuesday"]
    for number, day in enumerate(days):
        program("simulate", "large-loop-changed", "--seed", 7, "--day", 7 + number, "--until", 60, "--association",
                "known", "--out", day, "--quiet")
    program("join", *days, "--out", tmp_path / "program")
    helixnav.join(days, out=tmp_path / "python")
    table = (tmp_path / "python" / "map.csv").read_text()
    assert table == (tmp_path / "program" / "map.csv").read_text() and ",name\n" in table
