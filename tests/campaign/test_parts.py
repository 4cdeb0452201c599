# SPDX-License-Identifier: BSD-3-Clause
"""A campaign in parts, by Slurm with a task that is killed and requeued and by GNU parallel, is that of one machine.

    HELIXNAV_PROGRAM=build/dev/apps/helixnav python3 -m pytest tests/campaign [RUNS=2000 TASKS=20 in the environment]
"""
import json
import os
import pathlib
import shutil
import signal
import subprocess
import tempfile

import pytest

import slurm_node

EXAMPLES = pathlib.Path(__file__).resolve().parents[2] / "examples" / "campaign"
PROGRAM = os.path.abspath(os.environ["HELIXNAV_PROGRAM"])
TASKS = int(os.environ.get("TASKS", 3))
RUNS = int(os.environ.get("RUNS", 240)) // TASKS * TASKS
SCENARIO = os.environ.get("SCENARIO", "circuit")


def montecarlo(*words, code=0):
    done = subprocess.run([PROGRAM, "montecarlo", *map(str, words)], stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
    assert done.returncode == code, done.stderr
    return done.stderr if code else done.stdout


def without_wall_clock(path):
    """The lines of a file, byte by byte but for what the clock on the wall says."""
    text = path.read_text(encoding="utf-8")
    if path.suffix == ".jsonl":
        rows = [json.loads(line) for line in text.splitlines()]
        for row in rows:
            row.pop("wall")
        return [json.dumps(row) for row in rows]
    value = json.loads(text)
    assert path.name == "manifest.json" or value.pop("wall")
    return json.dumps(value, indent=2)


def is_that_of_one_machine(merged, whole):
    assert (merged / "manifest.json").read_bytes() == (whole / "manifest.json").read_bytes()
    for name in ("runs.jsonl", "summary.json"):
        assert without_wall_clock(merged / name) == without_wall_clock(whole / name), name


@pytest.fixture(scope="module")
def whole(tmp_path_factory):
    folder = tmp_path_factory.mktemp("whole") / "campaign"
    montecarlo(SCENARIO, "--seeds", f"1:{RUNS}", "--quiet", "--out", folder)
    return folder


@pytest.fixture
def shared():
    """Where daemons may write, with a name short enough for a socket."""
    folder = pathlib.Path(tempfile.mkdtemp(prefix="campaign_", dir="/tmp"))
    yield folder
    shutil.rmtree(folder, ignore_errors=True)


def lines_in(folder):
    file = folder / "runs.jsonl"
    return file.read_text(encoding="utf-8").count("\n") if file.exists() else 0


@pytest.mark.skipif(bool(slurm_node.missing()), reason=slurm_node.missing())
def test_a_slurm_array_with_a_task_killed_and_requeued(whole, shared):
    out = shared / "out"
    with slurm_node.one_node(shared / "slurm", cpus=2) as slurm:
        job = slurm.say("sbatch", "--parsable", f"--array=1-{TASKS}", f"--output={shared}/%a.log",
                        f"--export=ALL,HELIXNAV={PROGRAM}", EXAMPLES / "slurm_array.sh", out, RUNS // TASKS, SCENARIO).strip()
        first = out / "part_00001"
        slurm_node.until(lambda: lines_in(first) >= 2, 120, "the first task drives nothing")
        slurm.say("scontrol", "requeue", f"{job}_1")
        slurm_node.until(lambda: ("1", "PENDING") in slurm.tasks(job), 30, "it is not requeued")
        before = lines_in(first)
        assert 2 <= before < RUNS // TASKS, "it had ended: nothing was killed"
        assert "of its seeds were not driven" in montecarlo("--merge", first, "--out", shared / "half", code=3)
        # Had it begun anew before Slurm heard how the killed process ended, that would count as the end of the task.
        slurm_node.until(lambda: slurm.has_ended(f"{job}_1"), 60, "what was killed does not end")
        slurm.say("scontrol", "update", f"jobid={job}_1", "starttime=now")  # Slurm would let it wait for two minutes
        slurm.wait(job, seconds=60 + 2 * RUNS)
        task = slurm.say("scontrol", "show", "job", f"{job}_1")
        assert "Restarts=1" in task
        assert "JobState=COMPLETED" in task, task + (shared / "1.log").read_text(encoding="utf-8")
    parts = sorted(out.glob("part_*"))
    assert len(parts) == TASKS
    montecarlo("--merge", *parts, "--out", shared / "merged")
    is_that_of_one_machine(shared / "merged", whole)


@pytest.mark.skipif(shutil.which("parallel") is None, reason="not installed: parallel")
def test_gnu_parallel(whole, shared):
    command = [EXAMPLES / "gnu_parallel.sh", shared, str(RUNS), str(TASKS), SCENARIO]
    environment = {**os.environ, "HELIXNAV": PROGRAM, "PARALLEL_OPTIONS": "--jobs 2"}
    begun = subprocess.Popen(command, env=environment, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL,
                             start_new_session=True)
    slurm_node.until(lambda: lines_in(shared / f"part_1-{RUNS // TASKS}") >= 2, 60, "nothing is driven")
    os.killpg(begun.pid, signal.SIGKILL)  # the jobs, in groups of their own, live on for a while
    begun.wait()
    said = []

    def goes_on():
        done = subprocess.run(command, env=environment, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True)
        said.append(done.stdout)
        return done.returncode == 0

    slurm_node.until(goes_on, 120, said)
    assert all("another process writes into this folder" in text for text in said[:-1])
    is_that_of_one_machine(shared / "merged", whole)


def slurm_task(task, out, each):
    """slurm_array.sh as Slurm starts it, without Slurm."""
    return subprocess.run([EXAMPLES / "slurm_array.sh", out, str(each), SCENARIO], stderr=subprocess.PIPE, text=True,
                          stdout=subprocess.DEVNULL, env={**os.environ, "HELIXNAV": PROGRAM, "SLURM_ARRAY_TASK_ID": str(task)})


def test_a_task_knows_its_seeds_by_its_number_alone(tmp_path):
    for task in (1, 3):
        assert slurm_task(task, tmp_path, 2).returncode == 0
    seeds = json.loads((tmp_path / "part_00003" / "manifest.json").read_text(encoding="utf-8"))["seeds"]
    assert seeds == [[5, 6]]
    parts = [tmp_path / "part_00001", tmp_path / "part_00003"]
    assert "seeds 3 to 4 are in none" in montecarlo("--merge", *parts, "--out", tmp_path / "merged", code=3)
    assert slurm_task(2, tmp_path, 2).returncode == 0
    montecarlo("--merge", *parts, tmp_path / "part_00002", "--out", tmp_path / "merged")
    assert "counted from 1" in slurm_task(0, tmp_path, 2).stderr
