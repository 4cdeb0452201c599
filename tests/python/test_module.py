# SPDX-License-Identifier: BSD-3-Clause
import ast
import inspect
import pathlib
import threading

import numpy as np
import pytest

import helixnav


def small_odometry(t=0.0, dx=0.1):
    return helixnav.Odometry(t, [dx, 0.0, 0.0], np.diag([1e-4, 1e-4, 1e-6]))


def small_scan(t=0.0, points=((5.0, 1.0), (6.0, -2.0))):
    view = helixnav.FieldOfView(max_range=20.0)
    return helixnav.Scan(t, "cartesian", np.array(points), 0.01 * np.eye(2), view=view)


def test_a_navigator_maps_what_it_sees():
    navigator = helixnav.Navigator()
    for i in range(20):
        assert navigator.take(small_odometry(0.1 * i)) is None
        points = np.array([[5.0, 1.0], [6.0, -2.0]]) - [0.1 * (i + 1), 0.0]
        report = navigator.observe(small_scan(0.1 * i, points))
    assert report.step == 19 and report.mode == "mapping"
    assert [a.outcome for a in report.associations] == ["matched", "matched"]
    np.testing.assert_allclose(navigator.pose.mean, [2.0, 0.0, 0.0], atol=0.05)
    landmarks = navigator.map
    assert len(landmarks) == 2 and landmarks.ids.shape == (2,) and landmarks.observations.tolist() == [20, 20]
    np.testing.assert_allclose(landmarks.means, [[5.0, 1.0], [6.0, -2.0]], atol=0.1)
    assert landmarks.covariances.shape == (2, 2, 2)
    for covariance in landmarks.covariances:
        assert np.all(np.linalg.eigvalsh(covariance) > 0.0)
    assert set(landmarks.states) <= {"tentative", "mature"}


def test_a_named_navigator_goes_by_identities():
    navigator = helixnav.NamedNavigator(start=helixnav.Pose([1.0, 2.0, 0.0]))
    navigator.move(small_odometry())
    assert navigator.observe(small_scan(), [7, 9]).associations[0].outcome == "augmented"
    assert navigator.observe(small_scan(1.0), [9, 7]).associations[0].landmark == navigator.map.ids[1]
    with pytest.raises(helixnav.PreconditionError):
        navigator.observe(small_scan(2.0), [7])


def test_a_fix_moves_the_pose_and_is_reported():
    navigator = helixnav.Navigator(start=helixnav.Pose([0, 0, 0], np.diag([1.0, 1.0, 0.01])))
    assert navigator.fix(helixnav.AbsoluteFix(0.0, [1.0, 0.0], 0.01 * np.eye(2)))
    assert navigator.pose.x == pytest.approx(1.0, abs=0.02)
    decision, = navigator.observe(small_scan()).decisions
    assert decision.kind == "fix" and decision.verdict == "accepted" and decision.numbers["nis"] > 0.0
    assert decision.sentence.startswith("A position fix was used")


def test_bad_numbers_are_refused_and_change_nothing():
    navigator = helixnav.Navigator()
    navigator.observe(small_scan())
    before = navigator.pose.mean.tolist()
    for wrong in (
        lambda: helixnav.Odometry(0.0, [np.nan, 0, 0], np.eye(3)),
        lambda: helixnav.Odometry(0.0, [0, 0, 0], -np.eye(3)),
        lambda: helixnav.Scan(0.0, "range_bearing", [[np.inf, 0.0]], np.eye(2)),
        lambda: helixnav.Scan(0.0, "range_bearing", [[1.0, 0.0, 0.0]], np.eye(2)),
        lambda: helixnav.Scan(0.0, "bearing", [[1.0]], np.eye(2)),
        lambda: helixnav.Scan(0.0, "sonar", [[1.0]], np.eye(1)),
        lambda: helixnav.AbsoluteFix(0.0, [0.0, 0.0], np.zeros((2, 2))),
    ):
        with pytest.raises(helixnav.PreconditionError):
            wrong()
    with pytest.raises(TypeError):
        navigator.take("odometry")
    assert navigator.pose.mean.tolist() == before


def test_errors_are_those_of_python():
    assert issubclass(helixnav.InputError, ValueError)
    assert issubclass(helixnav.PreconditionError, ValueError)
    assert issubclass(helixnav.NumericalError, ArithmeticError)
    with pytest.raises(helixnav.InputError, match="nothing there"):
        helixnav.read_log("nowhere")
    with pytest.raises(helixnav.InputError):
        helixnav.simulate("no such scenario")
    with pytest.raises(helixnav.InputError):
        helixnav.evaluate("nowhere")


def test_options_are_those_of_a_configuration_file():
    log = helixnav.simulate("circuit", options={"search.particles": 300, "slip": {"enabled": False}})
    assert "particles = 300" in log.config and "enabled = false" in log.config
    with pytest.raises(helixnav.InputError, match="search.particles"):
        helixnav.simulate("circuit", options={"search.particels": 300})
    with pytest.raises(helixnav.InputError, match="search.particles"):
        helixnav.Navigator(options={"search.particles": "many"})
    helixnav.Navigator(options={"landmarks.tentative_patience_m": 12.0})


def test_scans_give_back_what_was_put_in():
    each = helixnav.Scan(1.5, "range_bearing", [[3.0, 0.1], [4.0, 0.2]], [0.1 * np.eye(2), 0.2 * np.eye(2)],
                         mounting=[0.3, 0.0, 0.1])
    assert len(each) == 2 and each.t == 1.5 and each.t_ns == 1_500_000_000
    assert each.z.tolist() == [[3.0, 0.1], [4.0, 0.2]] and each.kinds == ["range_bearing"] * 2
    assert each.mounting.tolist() == [0.3, 0.0, 0.1]
    assert len(helixnav.Scan(0.0, "range_bearing", np.empty((0, 2)), np.eye(2))) == 0
    bearings = helixnav.Scan(0.0, "bearing", [0.1, 0.2], [[0.01]])
    assert bearings.z[:, 0].tolist() == [0.1, 0.2] and np.isnan(bearings.z[:, 1]).all()


def test_other_threads_run_while_a_log_is_navigated():
    log = helixnav.simulate("circuit", seed=1)
    done = threading.Event()
    worker = threading.Thread(target=lambda: (helixnav.replay(log), done.set()))
    worker.start()
    counted = 0
    while not done.wait(0.0):
        counted += 1
    worker.join()
    assert counted > 100


def test_the_stubs_name_everything_that_there_is():
    stub = ast.parse(pathlib.Path(helixnav.__file__).with_name("__init__.pyi").read_text(encoding="utf-8"))
    classes = {node.name: node for node in stub.body if isinstance(node, ast.ClassDef)}
    functions = {node.name for node in stub.body if isinstance(node, ast.FunctionDef)}
    for name in helixnav.__all__:
        thing = getattr(helixnav, name)
        if not inspect.isclass(thing):
            assert name in functions and thing.__doc__
            continue
        told = {node.name for node in classes[name].body if isinstance(node, ast.FunctionDef)}
        told |= {node.target.id for node in classes[name].body if isinstance(node, ast.AnnAssign)}
        there = {member for member in vars(thing) if not member.startswith("_")}
        if not issubclass(thing, Exception):
            assert there == {member for member in told if not member.startswith("_")}, name
        assert thing.__doc__, name
