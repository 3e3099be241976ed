# SPDX-License-Identifier: BSD-3-Clause
"""Two processes that take turns share a core while they do, and no longer."""

from __future__ import annotations

import os
import subprocess
import sys
import threading

import gymnasium as gym
import pytest

import sitl.envs
from sitl.foreign.one_core import IS_OFFERED, OneCore

if not IS_OFFERED:
    pytest.skip("this platform does not let a process choose its cores", allow_module_level=True)


@pytest.fixture
def other():
    """A process that waits."""
    with subprocess.Popen([sys.executable, "-c", "input()"], stdin=subprocess.PIPE) as process:
        yield process
        process.kill()


@pytest.fixture(autouse=True)
def _cores_are_given_back():
    before = os.sched_getaffinity(0)
    yield
    assert os.sched_getaffinity(0) == before


def test_both_are_on_one_core_inside_and_this_thread_has_its_own_outside(other):
    before, shared = os.sched_getaffinity(0), OneCore(other.pid)
    for _ in range(3):
        with shared:
            core = os.sched_getaffinity(0)
            assert len(core) == 1 and core <= before
            assert os.sched_getaffinity(other.pid) == core
        assert os.sched_getaffinity(0) == before


def test_an_error_inside_gives_the_cores_back(other):
    before = os.sched_getaffinity(0)
    with pytest.raises(ZeroDivisionError), OneCore(other.pid):
        1 / 0  # noqa: B018
    assert os.sched_getaffinity(0) == before


def test_a_process_that_has_ended_is_no_error_and_binds_nobody(other):
    other.kill()
    other.wait()
    before = os.sched_getaffinity(0)
    with OneCore(other.pid):
        assert os.sched_getaffinity(0) == before


def test_without_another_process_nothing_happens():
    before = os.sched_getaffinity(0)
    with OneCore(None):
        assert os.sched_getaffinity(0) == before


def test_threads_that_are_started_between_two_turns_have_all_cores(other):
    found = []
    with OneCore(other.pid):
        pass
    thread = threading.Thread(target=lambda: found.append(os.sched_getaffinity(0)))
    thread.start()
    thread.join()
    assert found == [os.sched_getaffinity(0)]


@pytest.mark.slow
def test_the_steps_of_an_environment_are_on_the_autopilots_core(ardurover):
    env = gym.make("GazeboMazeErleRoverLIDAR-v0", autopilot=f"ardupilot:{ardurover}")
    env.reset(seed=1)
    before, link = os.sched_getaffinity(0), env.unwrapped.robot.link(0)
    step, seen = link.host.step, []

    def watched(*until):
        seen.append((os.sched_getaffinity(0), os.sched_getaffinity(link.process.pid)))
        step(*until)

    link.host.step = watched
    env.step(0)
    assert seen and all(ours == theirs and len(ours) == 1 for ours, theirs in seen)
    assert os.sched_getaffinity(0) == before
    link.process._signal(9)
    with pytest.raises(sitl.envs.LinkLostError):
        env.step(0)
    assert os.sched_getaffinity(0) == before
    env.close()
