# SPDX-License-Identifier: BSD-3-Clause
"""The interpreter ends while a thread is in our code."""
import subprocess
import sys

import pytest

THREAD = """
import threading, time
import helixnav
log = helixnav.simulate("town", 1)
def replay():
    helixnav.replay(log)
def steps():
    navigator = helixnav.Navigator(log)
    for event in log.events: navigator.take(event)
def pose():
    navigator = helixnav.Navigator(log)
    while True: navigator.pose.mean; navigator.map
def simulate():
    while True: helixnav.simulate("large-loop", 1)
threading.Thread(target={work}, daemon=True).start()
time.sleep(0.5)
print("main ends", flush=True)
"""


@pytest.mark.parametrize("work", ["replay", "steps", "pose", "simulate"])
def test_a_daemon_thread_does_not_abort_the_process(work):
    for _ in range(3):
        done = subprocess.run([sys.executable, "-c", THREAD.replace("{work}", work)], stdout=subprocess.PIPE,
                              stderr=subprocess.PIPE, text=True, timeout=60)
        assert (done.returncode, done.stdout, done.stderr) == (0, "main ends\n", "")
