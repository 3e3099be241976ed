# SPDX-License-Identifier: BSD-3-Clause
"""Vehicles after boot and take-off are shared by the environments of a process that would make the same ones."""

from __future__ import annotations

import threading
from dataclasses import replace
from importlib.util import find_spec

import gymnasium as gym
import numpy as np
import pytest

import sitl.envs  # noqa: F401
from sitl import vehicles, worlds
from sitl.envs.robots import in_process, starts
from sitl.envs.robots.autopilot import AutopilotRobot
from sitl.envs.robots.starts import Origin, Starts

HOVER = "sitl/CopterHover-v1"


@pytest.fixture
def kept(monkeypatch):
    monkeypatch.setattr(in_process, "STARTS", Starts())
    return in_process.STARTS


def episodes(env, seeds=range(5)):
    seen = []
    for seed in seeds:
        seen.append(env.reset(seed=seed)[0])
        seen += [env.step(np.full(env.action_space.shape, 0.3, np.float32))[0] for _ in range(4)]
    return np.array(seen)


@pytest.mark.parametrize("options", [{}, {"begin": "boot"}, {"physics": "pybullet", "randomise": {}}])
def test_a_second_environment_boots_nothing_and_sees_the_same(kept, monkeypatch, options):
    if "physics" in options:
        pytest.importorskip(options["physics"])
    first = episodes(gym.make(HOVER, **options))
    count = len(kept)
    again = gym.make(HOVER, **options)

    def boots(*arguments):
        raise AssertionError("a vehicle boots again")

    monkeypatch.setattr(in_process.InProcessVehicles, "_started", boots)
    assert np.array_equal(episodes(again), first)
    assert len(kept) == count > 1


def test_what_is_made_ready_for_set_points_does_not_depend_on_what_was_before(kept):
    def ready():
        return {key[-1]: start.ready for key, start in kept._kept.items() if start.ready}

    episodes(gym.make(HOVER), range(4))
    together = ready()
    assert len(together) > 2
    for seed in range(4):
        kept.clear()
        episodes(gym.make(HOVER), (seed,))
        ((boot, alone),) = ready().items()
        for used, snapshot in alone.items():
            assert bytes(snapshot.record) == bytes(together[boot][used].record)
            assert snapshot.bridge == together[boot][used].bridge


def test_what_does_not_change_a_boot_shares_it(kept):
    episodes(gym.make(HOVER))
    count = len(kept)
    for options in ({"latency": 0.2}, {"judge": "estimate"}, {"step_time": 0.2}, {"faults": {"motor:2=0.8": 0.0}}):
        episodes(gym.make(HOVER, **options))
    many = gym.make_vec(HOVER, num_envs=3, vectorization_mode="vector_entry_point")
    many.reset(seed=0)
    assert len(kept) == count


def origin(frame="erle_copter", world="open", **options):
    return Origin(*_made(frame, world, options))


def _made(frame, world, options):
    setup = AutopilotRobot(world, 1, frame=frame, **options)._setup
    return setup, setup.world


def test_origins_are_told_apart_by_all_that_a_start_depends_on():
    engines = [name for name in ("pybullet", "jsbsim") if find_spec(name)]
    copter = vehicles.load("erle_copter")
    heavier = copter.changed(mass=1.3)
    iron = copter.changed(mag_offset=(1e-6, 0.0, 0.0))
    found = [
        origin(),
        origin("erle_rover"),
        origin(heavier),
        origin(iron),
        origin(world="office_erlecopter"),
        origin(take_off=2.0),
        origin(home=(47.0, 8.0, 400.0, 0.0)),
        origin(params={"WPNAV_SPEED": 300.0}),
        origin(params={"WPNAV_SPEED": 400.0}),
        origin(sensors="rtk"),
        *(origin(physics=engine) for engine in engines),
    ]
    for i, one in enumerate(found):
        assert [one == other for other in found] == [i == j for j in range(len(found))]
    assert origin() == found[0] and hash(origin()) == hash(found[0])
    assert origin(vehicles.load("erle_copter").changed(mass=1.3)) == found[2]
    assert origin(world=worlds.load("office_erlecopter")) == found[4]
    assert found[0] != "open"


def test_a_world_that_can_be_changed_shares_nothing(kept):
    """Its starts are as those of the same world of tuples."""
    fixed = worlds.load("open")
    (start,) = fixed.starts[:1]
    loose = replace(fixed, starts=(replace(start, position=list(start.position)),))
    options = {"frame": "erle_copter", "boots": 1}
    robots = [AutopilotRobot(world, 1, **options) for world in (fixed, loose, loose)]
    for robot in robots:
        robot.reset(0, (1.0, 0.0, 0.0, 0.5), 3)
    assert len(kept) == 3
    assert np.array_equal(robots[0].state, robots[1].state) and np.array_equal(robots[1].state, robots[2].state)


def test_in_plain_python_each_environment_has_its_own(monkeypatch):
    monkeypatch.setattr(starts, "unit_address", lambda unit, kind: 0)
    setup, world = _made("erle_copter", "open", {})
    one = Origin(setup, world)
    assert one == one and one != Origin(setup, world)


def test_a_message_that_is_asked_for_later_makes_other_starts(kept):
    robot = AutopilotRobot("open", 1, frame="erle_copter", boots=1)
    pose = (0.0, 0.0, 0.0, 0.0)
    robot.reset(0, pose, 1)
    robot.ask_for("EXTENDED_SYS_STATE")
    robot.reset(0, pose, 1)
    assert len(kept) == 2


def test_what_was_not_used_for_longest_goes_first():
    kept, made = Starts(2), []

    def make(key):
        made.append(key)
        return key

    def of(key):
        return kept.of(key, lambda: make(key))

    first = of("a")
    of("b")
    assert of("a") is first
    of("c")
    of("a")
    of("b")
    assert made == ["a", "b", "c", "b"] and len(kept) == 2
    kept.clear()
    assert len(kept) == 0


def test_threads_that_make_the_same_get_the_same():
    kept, both, found = Starts(), threading.Barrier(2), []

    def make():
        both.wait(10.0)
        return object()

    threads = [threading.Thread(target=lambda: found.append(kept.of("key", make))) for _ in range(2)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    assert found[0] is found[1] and len(kept) == 1
