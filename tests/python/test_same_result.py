# SPDX-License-Identifier: BSD-3-Clause
"""One log through the program, the stream and Python: the same numbers, to the last digit."""
import csv
import json

import numpy as np
import pytest

import helixnav


def lines_of(folder, seconds):
    """Rows in order of time as JSON Lines; numbers stand as text, as the tables have them."""
    events = {}
    for order, name in enumerate(("detections", "odometry")):
        with open(folder / f"{name}.csv", encoding="utf-8") as table:
            for row in csv.DictReader(table):
                t = float(row["t_s"])
                if t <= seconds:
                    events.setdefault((t, order, name), []).append({key: cell for key, cell in row.items() if cell})
    return [json.dumps({name: rows}) for (_, _, name), rows in sorted(events.items())]


@pytest.fixture(scope="module")
def lines(own_log, tmp_path_factory):
    path = tmp_path_factory.mktemp("lines") / "log.jsonl"
    path.write_text("\n".join(lines_of(own_log, 60.0)) + "\n", encoding="utf-8")
    return path


def test_program_stream_and_python_agree_to_the_last_digit(program, own_log, lines, tmp_path):
    vehicle = own_log / "vehicle.toml"
    program("replay", lines, "--vehicle", vehicle, "--out", tmp_path / "program", "--quiet")
    with open(lines, encoding="utf-8") as stdin:
        answers = program("stream", "--vehicle", vehicle, "--out", tmp_path / "stream", stdin=stdin)
    log = helixnav.read_log(str(lines), vehicle=str(vehicle))
    run = helixnav.replay(log, out=str(tmp_path / "python"))
    for name in ("trajectory.tum", "map.csv", "associations.csv", "decisions.csv"):
        text = (tmp_path / "program" / name).read_text()
        assert (tmp_path / "python" / name).read_text() == text, name
        assert (tmp_path / "stream" / name).read_text() == text, name

    navigator = helixnav.Navigator(log)
    steps = [step for step in map(navigator.take, log.events) if step is not None]
    scans = [json.loads(line)["scan"] for line in answers.splitlines() if line.startswith('{"scan"')]
    assert len(steps) == len(scans) == len(run) > 50
    for step, scan in zip(steps, scans):
        assert [step.pose.x, step.pose.y, step.pose.heading] == [scan["x"], scan["y"], scan["heading"]]
        assert np.array_equal(np.triu(step.pose.covariance), np.triu(scan["covariance"]))
        assert [a.landmark for a in step.associations] == [a["landmark"] for a in scan["associations"]]
        assert [a.outcome for a in step.associations] == [a["outcome"] for a in scan["associations"]]
    assert np.array_equal(navigator.map.means, run.map.means)
    assert np.array_equal(navigator.map.ids, run.map.ids)


def poses_of(reports):
    return [(report.step, report.pose.x, report.pose.y, report.pose.heading) for report in reports]


def stepwise(vehicle, lines):
    """By the Stream of the module."""
    stream = helixnav.Stream(vehicle)
    reports = [report for line in lines for report in stream.take(line)]
    return stream, reports + stream.finish()


def test_a_stream_fed_from_python_is_the_program_s(program, own_log, lines):
    vehicle = own_log / "vehicle.toml"
    with open(lines, encoding="utf-8") as stdin:
        answers = program("stream", "--vehicle", vehicle, stdin=stdin)
    scans = [json.loads(line)["scan"] for line in answers.splitlines() if line.startswith('{"scan"')]
    stream, reports = stepwise(vehicle, lines.read_text().splitlines())
    assert [pose[1:] for pose in poses_of(reports)] == [(s["x"], s["y"], s["heading"]) for s in scans]
    assert not stream.take_refused()
    assert len(stream.map) > 10 and len(stream.joint_map()) == len(stream.map)


def test_a_stream_puts_late_scans_where_they_were_taken(own_log, lines):
    vehicle = own_log / "vehicle.toml"
    rows = [json.loads(line) for line in lines.read_text().splitlines()]
    times = [float(next(iter(row.values()))[0]["t_s"]) for row in rows]
    arrival = [t + (0.45 if "detections" in row else 0.0) for t, row in zip(times, rows)]
    late = [rows[i] for i in sorted(range(len(rows)), key=lambda i: (arrival[i], i))]
    assert late != rows
    in_order, late_stream = stepwise(vehicle, rows), stepwise(vehicle, late)
    assert poses_of(late_stream[1]) == poses_of(in_order[1])


def test_a_stream_refuses_by_line_and_goes_on(own_log, lines):
    rows = lines.read_text().splitlines()
    stream, reports = stepwise(own_log / "vehicle.toml", [*rows[:200], "{nonsense", {"odometry": {"t": -1e9}}, *rows[200:]])
    assert [line for line, _, _ in stream.take_refused()] == [201, 202]
    assert stream.take_refused() == []
    assert poses_of(reports) == poses_of(stepwise(own_log / "vehicle.toml", rows)[1])
    with pytest.raises(TypeError):
        stream.take(17)
    with pytest.raises(helixnav.InputError):
        helixnav.Stream(own_log / "no.toml")
    with pytest.raises(helixnav.InputError):
        helixnav.Stream(own_log / "vehicle.toml", options={"search.particle": 3})


def test_a_folder_of_tables_is_read_as_the_program_reads_it(program, own_log, tmp_path):
    program("replay", own_log, "--out", tmp_path / "program", "--quiet", "--search.particles", 500)
    log = helixnav.read_log(own_log, options={"search.particles": 500})  # with the vehicle.toml in it
    run = helixnav.replay(log, out=tmp_path / "python")
    for name in ("trajectory.tum", "map.csv", "associations.csv", "decisions.csv"):
        assert (tmp_path / "python" / name).read_text() == (tmp_path / "program" / name).read_text(), name
    assert (tmp_path / "python" / "map.bin").read_bytes() == (tmp_path / "program" / "map.bin").read_bytes()
    assert run.evaluate() == json.loads(program("evaluate", tmp_path / "program", "--json"))
    with pytest.raises(helixnav.InputError, match="not empty"):
        helixnav.replay(log, out=tmp_path / "python")
    helixnav.replay(log, out=tmp_path / "python", overwrite=True)


def test_simulate_and_replay_are_those_of_the_program(program, tmp_path):
    program("simulate", "circuit", "--seed", 3, "--out", tmp_path / "program", "--quiet")
    run = helixnav.replay(helixnav.simulate("circuit", seed=3), out=str(tmp_path / "python"))
    for name in ("trajectory.tum", "map.csv", "associations.csv", "decisions.csv", "truth_poses.csv"):
        assert (tmp_path / "python" / name).read_text() == (tmp_path / "program" / name).read_text(), name
    assert run.evaluate() == helixnav.evaluate(str(tmp_path / "program"))
    assert json.loads(program("evaluate", tmp_path / "python", "--json")) == run.evaluate()
    assert program("explain", tmp_path / "python").splitlines()[0] == run.explain().splitlines()[0]
    assert np.array_equal(helixnav.read_run(str(tmp_path / "program")).trajectory, run.trajectory)
