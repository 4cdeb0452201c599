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
    assert 0.0 < report.numerics.least_pivot <= 1.0 and report.numerics.refused == report.numerics.repaired == 0
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


def test_classes_and_sizes_are_told_and_kept():
    navigator = helixnav.Navigator()
    for i in range(20):
        navigator.move(small_odometry(0.1 * i))
        points = np.array([[5.0, 1.0], [6.0, -2.0]]) - [0.1 * (i + 1), 0.0]
        scan = helixnav.Scan(0.1 * i, "cartesian", points, 0.01 * np.eye(2), view=helixnav.FieldOfView(max_range=20.0),
                             classes=["oak", None], sizes=[np.nan, 0.4], sigma_sizes=0.02)
        assert scan.classes == ["oak", ""]
        np.testing.assert_array_equal(scan.sizes, [np.nan, 0.4])
        np.testing.assert_array_equal(scan.sigma_sizes, [np.nan, 0.02])
        navigator.observe(scan)
    assert navigator.map.classes == ["oak", ""]
    assert np.all(np.isnan(navigator.map.sizes[0]))
    np.testing.assert_allclose(navigator.map.sizes[1], [0.4, 0.02 / np.sqrt(20)], rtol=0.05)  # a size may say nothing


@pytest.mark.parametrize("told", [{"classes": ["oak"]}, {"classes": ["a name of more than 23 bytes", None]},
                                  {"classes": ["oak", "elm"], "class_error": 0.0}, {"sizes": [0.4, 0.4]},
                                  {"sizes": [0.4, -1.0], "sigma_sizes": 0.1}, {"sizes": [0.4], "sigma_sizes": 0.1}])
def test_what_cannot_be_a_class_or_a_size_is_refused(told):
    with pytest.raises(helixnav.PreconditionError):
        helixnav.Scan(0.0, "cartesian", [[5.0, 1.0], [6.0, -2.0]], np.eye(2), **told)


EYE2, EYE3 = np.eye(2), np.eye(3)


@pytest.mark.parametrize("wrong", (
    lambda: helixnav.Odometry(0.0, [np.nan, 0, 0], EYE3),
    lambda: helixnav.Odometry(np.nan, [0, 0, 0], EYE3),
    lambda: helixnav.Odometry(1e300, [0, 0, 0], EYE3),
    lambda: helixnav.Odometry(0.0, [0, 0, 0], -EYE3),
    lambda: helixnav.Odometry(0.0, [0, 0, 0], EYE2),
    lambda: helixnav.Odometry(0.0, [[0, 0, 0]], EYE3),
    lambda: helixnav.Scan(0.0, "range_bearing", [[np.inf, 0.0]], EYE2),
    lambda: helixnav.Scan(0.0, "range_bearing", [[1.0, 0.0, 0.0]], EYE2),
    lambda: helixnav.Scan(0.0, "range_bearing", [1.0, 0.0], EYE2),
    lambda: helixnav.Scan(0.0, "range_bearing", 1.0, EYE2),
    lambda: helixnav.Scan(0.0, "range_bearing", [[1.0, 0.0]], [EYE2, EYE2]),
    lambda: helixnav.Scan(0.0, "range_bearing", [[1.0, 7.0]], EYE2),
    lambda: helixnav.Scan(0.0, "bearing", [[1.0]], EYE2),
    lambda: helixnav.Scan(0.0, "sonar", [[1.0]], np.eye(1)),
    lambda: helixnav.Scan(0.0, "cartesian", [[1.0, 0.0]], EYE2, mounting=[0.0, 0.0]),
    lambda: helixnav.Scan(0.0, "cartesian", [[1.0, 0.0]], EYE2, view=helixnav.FieldOfView(np.nan)),
    lambda: helixnav.AbsoluteFix(0.0, [0.0, 0.0], np.zeros((2, 2))),
    lambda: helixnav.AbsoluteFix(0.0, [], EYE2),
    lambda: helixnav.Pose([0.0, np.inf, 0.0]),
    lambda: helixnav.Pose([0.0, 0.0, 0.0], -EYE3),
))
def test_numbers_that_cannot_be_are_refused(wrong):
    with pytest.raises(helixnav.PreconditionError):
        wrong()


@pytest.mark.parametrize("wrong", (
    lambda: helixnav.Odometry(0.0, None, EYE3),
    lambda: helixnav.Odometry("0", [0, 0, 0], EYE3),
    lambda: helixnav.Odometry(0.0, ["0", "0", "0"], EYE3),
    lambda: helixnav.Odometry(0.0, [0, 0, 0], 1j * EYE3),
    lambda: helixnav.Scan(0.0, "cartesian", [[1.0, None]], EYE2),
    lambda: helixnav.Scan(0.0, "cartesian", [[1.0, 0.0], [1.0]], EYE2),
    lambda: helixnav.Scan(0.0, "cartesian", [[1.0, 0.0]], EYE2, view=None),
    lambda: helixnav.Navigator(None),
    lambda: helixnav.Navigator(options=None),
    lambda: helixnav.Navigator().take("odometry"),
    lambda: helixnav.Navigator().take(None),
    lambda: helixnav.Navigator().observe(small_odometry()),
    lambda: helixnav.NamedNavigator().observe(small_scan(), [0.5, 1.5]),
    lambda: helixnav.NamedNavigator().observe(small_scan(), None),
    lambda: helixnav.replay(None),
    lambda: helixnav.evaluate(None),
    lambda: helixnav.read_log(None),
    lambda: helixnav.simulate("circuit", seed=-1),
))
def test_what_is_no_number_no_event_or_no_log_is_a_type_error(wrong):
    with pytest.raises(TypeError):
        wrong()


def test_messages_name_the_argument_and_both_shapes():
    with pytest.raises(helixnav.PreconditionError, match=r"covariance: expected an array of shape \(3, 3\), found \(2, 2\)"):
        helixnav.Odometry(0.0, [0, 0, 0], EYE2)
    with pytest.raises(TypeError, match="increment: expected real numbers, found an array of object"):
        helixnav.Odometry(0.0, [None, 0, 0], EYE3)


def test_a_refused_event_changes_nothing():
    navigator = helixnav.Navigator()
    navigator.observe(small_scan(1.0))
    before = navigator.pose.mean.tolist(), navigator.map.means.tolist()
    broken = small_scan(2.0)
    broken.view.max_range = np.nan
    with pytest.raises(helixnav.PreconditionError, match="field of view"):
        navigator.observe(broken)
    assert (navigator.pose.mean.tolist(), navigator.map.means.tolist()) == before
    assert navigator.observe(small_scan(2.0)).step == 1


def test_arrays_of_any_layout_and_real_type_are_taken_as_they_read():
    points = np.arange(12.0).reshape(6, 2) + 1.0
    for layout in (np.asfortranarray(points), np.repeat(points, 2, axis=0)[::2], points[::-1][::-1],
                   points.astype(np.float32), points.astype(np.int16), points.astype(">f8"), points.tolist()):
        assert np.array_equal(helixnav.Scan(0.0, "cartesian", layout, EYE2).z, points)
    skewed = np.array([[2.0, 0.5], [0.5, 1.0]])
    assert np.array_equal(helixnav.Scan(0.0, "cartesian", points, np.asfortranarray(skewed)).R[3], skewed)


def test_what_is_read_out_is_a_copy():
    navigator = helixnav.Navigator()
    navigator.observe(small_scan())
    navigator.map.means[:] = 0.0
    navigator.pose.mean[:] = 9.0
    assert np.abs(navigator.map.means).max() > 1.0 and navigator.pose.x == 0.0


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
    assert repr(helixnav.InputError("x")) == "InputError('x')" and helixnav.InputError.__module__ == "helixnav"


def test_options_are_those_of_a_configuration_file():
    log = helixnav.simulate("circuit", options={"search.particles": 300, "slip": {"enabled": False}})
    assert "particles = 300" in log.config and "enabled = false" in log.config
    with pytest.raises(helixnav.InputError, match="search.particles"):
        helixnav.simulate("circuit", options={"search.particels": 300})
    with pytest.raises(helixnav.InputError, match="is for replay and simulate"):
        helixnav.Navigator(options={"map.memory_mb": 100})
    with pytest.raises(helixnav.InputError, match="search.particles"):
        helixnav.Navigator(options={"search.particles": "many"})
    with pytest.raises(helixnav.InputError, match="landmarks.tentative_patience_m"):
        helixnav.Navigator(options={"landmarks.tentative_patience_m": np.nan})
    helixnav.Navigator(options={"landmarks.tentative_patience_m": 12.0, "search.particles": np.int32(200),
                                "slip.enabled": np.bool_(False)})


def test_scans_give_back_what_was_put_in():
    each = helixnav.Scan(1.5, "range_bearing", [[3.0, 0.1], [4.0, 0.2]], [0.1 * np.eye(2), 0.2 * np.eye(2)],
                         mounting=[0.3, 0.0, 0.1])
    assert len(each) == 2 and each.t == 1.5 and each.t_ns == 1_500_000_000
    assert each.z.tolist() == [[3.0, 0.1], [4.0, 0.2]] and each.kinds == ["range_bearing"] * 2
    assert each.mounting.tolist() == [0.3, 0.0, 0.1]
    assert each.R.tolist() == [(0.1 * EYE2).tolist(), (0.2 * EYE2).tolist()]
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


def test_threads_that_share_a_navigator_take_turns():
    log = helixnav.simulate("circuit", seed=1)
    navigator = helixnav.Navigator(log)
    scan = next(event for event in log.events if isinstance(event, helixnav.Scan) and len(event) > 0)

    def work():
        for _ in range(50):
            navigator.observe(scan)
            assert np.isfinite(navigator.pose.mean).all() and len(navigator.map) > 0

    workers = [threading.Thread(target=work) for _ in range(4)]
    for worker in workers:
        worker.start()
    for worker in workers:
        worker.join()
    assert navigator.observe(scan).step == 200


def test_the_stubs_name_everything_that_there_is():
    stub = ast.parse(pathlib.Path(helixnav.__file__).with_name("__init__.pyi").read_text(encoding="utf-8"))
    classes = {node.name: node for node in stub.body if isinstance(node, ast.ClassDef)}
    functions = {node.name for node in stub.body if isinstance(node, ast.FunctionDef)}
    aliases = {target.id for node in stub.body if isinstance(node, ast.Assign) for target in node.targets}
    assert all(name.startswith("_") for name in aliases), "names that nobody can import"
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
