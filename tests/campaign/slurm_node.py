# SPDX-License-Identifier: BSD-3-Clause
"""A Slurm of one node in a folder of its own: its daemons run as long as the with block, as root, on free ports of loopback."""
import contextlib
import os
import pathlib
import shutil
import socket
import subprocess
import time

DAEMONS = ("munged", "slurmctld", "slurmd", "sbatch", "squeue", "scontrol")
PATH = "/usr/sbin:/sbin:" + os.environ["PATH"]


def missing():
    """Of what it needs, in words; empty when nothing is missing."""
    gone = [name for name in DAEMONS if shutil.which(name, path=PATH) is None]
    if gone:
        return "not installed (slurm-wlm, munge): " + ", ".join(gone)
    return "" if os.geteuid() == 0 else "daemons are started as root only"


def free_port():
    with socket.socket() as one:
        one.bind(("127.0.0.1", 0))
        return one.getsockname()[1]


def configuration(folder, cpus):
    host = socket.gethostname().split(".")[0]
    memory_mb = os.sysconf("SC_PAGE_SIZE") * os.sysconf("SC_PHYS_PAGES") // 2**20 // 2
    return f"""ClusterName=one
SlurmctldHost={host}(127.0.0.1)
SlurmUser=root
SlurmdUser=root
SlurmctldPort={free_port()}
SlurmdPort={free_port()}
AuthType=auth/munge
AuthInfo=socket={folder}/munge.socket
CredType=cred/munge
StateSaveLocation={folder}/state
SlurmdSpoolDir={folder}/spool
SlurmctldPidFile={folder}/slurmctld.pid
SlurmdPidFile={folder}/slurmd.pid
SlurmctldLogFile={folder}/slurmctld.log
SlurmdLogFile={folder}/slurmd.log
ProctrackType=proctrack/linuxproc
TaskPlugin=task/none
MpiDefault=none
ReturnToService=2
SchedulerType=sched/backfill
SchedulerParameters=sched_interval=1,sched_min_interval=100000
SelectType=select/cons_tres
SelectTypeParameters=CR_CPU
JobRequeue=1
KillWait=2
SlurmdParameters=config_overrides
NodeName={host} NodeAddr=127.0.0.1 CPUs={cpus} RealMemory={memory_mb} State=UNKNOWN
PartitionName=all Nodes={host} Default=YES MaxTime=INFINITE State=UP
"""


class Slurm:
    def __init__(self, folder):
        self.folder = folder
        self.environment = {**os.environ, "SLURM_CONF": str(folder / "slurm.conf"), "PATH": PATH}

    def say(self, *words):
        done = subprocess.run([str(word) for word in words], env=self.environment, stdout=subprocess.PIPE,
                              stderr=subprocess.STDOUT, text=True)
        assert done.returncode == 0, f"{words}: {done.stdout}"
        return done.stdout

    def tasks(self, job):
        """[(task, state)] of those not yet ended."""
        return [tuple(line.split()) for line in
                self.say("squeue", "--noheader", "--array", "--job", job, "--format", "%K %T").splitlines()]

    def has_ended(self, task):
        """Whether a process of that task has ended, and Slurm knows how."""
        job_id = self.say("scontrol", "show", "job", task).split("JobId=", 1)[1].split()[0]
        return f"[{job_id}.batch] done with job" in (self.folder / "slurmd.log").read_text(encoding="utf-8")

    def wait(self, job, seconds):
        until = time.monotonic() + seconds
        while self.tasks(job):
            assert time.monotonic() < until, self.say("squeue", "--array")
            time.sleep(0.5)


def until(condition, seconds, what):
    end = time.monotonic() + seconds
    while not condition():
        assert time.monotonic() < end, what
        time.sleep(0.2)


@contextlib.contextmanager
def one_node(folder, cpus):
    folder = pathlib.Path(folder)
    for name in ("state", "spool"):
        (folder / name).mkdir(parents=True)
    folder.chmod(0o755)
    (folder / "slurm.conf").write_text(configuration(folder, cpus), encoding="utf-8")
    (folder / "munge.key").write_bytes(os.urandom(1024))
    (folder / "munge.key").chmod(0o400)
    slurm = Slurm(folder)
    started = []

    def start(*words):
        log = open(folder / f"{words[0]}.out", "w", encoding="utf-8")
        started.append(subprocess.Popen(words, env=slurm.environment, stdout=log, stderr=log, cwd=folder))

    try:
        start("munged", "--foreground", "--force", f"--key-file={folder}/munge.key", f"--socket={folder}/munge.socket",
              f"--pid-file={folder}/munge.pid", f"--seed-file={folder}/munge.seed", f"--log-file={folder}/munge.log")
        until((folder / "munge.socket").exists, 20, "munged does not answer")
        start("slurmctld", "-D", "-i")
        start("slurmd", "-D")
        until(lambda: "idle" in subprocess.run(["sinfo", "--noheader", "--format", "%T"], env=slurm.environment,
                                               stdout=subprocess.PIPE, stderr=subprocess.DEVNULL, text=True).stdout,
              60, "no node is idle: see the logs in " + str(folder))
        yield slurm
    finally:
        for daemon in reversed(started):
            daemon.terminate()
        for daemon in reversed(started):
            with contextlib.suppress(subprocess.TimeoutExpired):
                daemon.wait(10)
            if daemon.poll() is None:
                daemon.kill()
