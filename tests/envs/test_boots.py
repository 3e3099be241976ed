# SPDX-License-Identifier: BSD-3-Clause
"""Each episode has its own boot: errors of the estimate are drawn by its seed, from the distribution of real boots."""

from __future__ import annotations

import math

import gymnasium as gym
import numpy as np
import pytest

import sitl.envs  # noqa: F401 - registers the ids
from sitl import vehicles
from sitl.autopilot.estimation.state import POS, VEL
from sitl.core.algebra import euler_of
from sitl.core.geodesy import offset_ne
from sitl.core.scalars import wrap_pi
from sitl.envs.actions import VELOCITY
from sitl.envs.options import EnvOptionError
from sitl.envs.robots.autopilot import AutopilotRobot
from sitl.envs.vector import NavigateVector

COPTER, ROVER = "erle_copter", "erle_rover"
NAMES = ("north", "east", "down", "v north", "v east", "v down", "yaw", "roll", "pitch")


def made(frame, **options):
    return AutopilotRobot("open", 1, frame=frame, take_off=3.0, **options)


def error(robot, index=0):
    """Estimate minus truth: position, velocity, yaw, roll, pitch."""
    v = robot.view(index)
    e, body, place = v.autopilot.estimate, v.physics.body, v.physics.origin
    north, east = offset_ne(place.lat, place.lon, e.origin_lat, e.origin_lon)
    true = euler_of(body.q)
    angles = wrap_pi(e.euler.yaw - true.yaw), e.euler.roll - true.roll, e.euler.pitch - true.pitch
    return [
        north + e.pos.x - body.pos.x,
        east + e.pos.y - body.pos.y,
        e.pos.z - body.pos.z,
        *(e.vel - body.vel),
        *angles,
    ]


def starts(robot, seeds, pose=(3.0, 2.0, 0.0, 0.5)):
    found = []
    for seed in seeds:
        robot.reset(0, pose, seed)
        found.append(error(robot))
    return np.array(found)


@pytest.mark.parametrize("frame", [COPTER, ROVER])
def test_each_seed_has_its_own_errors_and_one_boot_the_same_ones(frame):
    many, one = starts(made(frame, boots=3), range(8)), starts(made(frame, boots=1), range(8))
    assert np.all(many[:, [0, 1]].std(0) > 0.1) and np.all(many[:, 3:7].std(0) > 1e-3)
    assert len({tuple(row) for row in many.tolist()}) == 8
    assert np.all(one.std(0) < 1e-12)


def test_the_single_boot_is_that_of_seed_0():
    north, east, down = starts(made(COPTER, boots=1), [5], (0.0, 0.0, 0.0, 0.0))[0, :3]
    assert (north, -east, -down) == pytest.approx((-0.388, 0.620, -0.062), abs=0.001)
    with gym.make("sitl/CopterHover-v0") as env:  # as published
        assert env.unwrapped.robot._options.boots == 1
    with gym.make("sitl/CopterHover-v1") as env:
        assert env.unwrapped.robot._options.boots == 64


@pytest.mark.parametrize("frame", [COPTER, ROVER])
def test_the_estimate_does_not_jump_when_the_episode_goes_on(frame):
    """What the filter sees fits what it believes: it has no more to correct than a vehicle that booted so."""
    robot = made(frame, boots=2, params={"SIM_WIND_SPD": 0})
    robot.apply(VELOCITY, np.zeros((1, 4)))
    for seed in range(6):
        robot.reset(0, (3.0, 2.0, 0.0, 0.5), seed)
        before = error(robot)
        robot.advance(1.0)
        assert max(abs(b - a) for a, b in zip(before[:3], error(robot)[:3], strict=True)) < 0.25


def test_the_start_depends_on_the_seed_alone():
    seeds = [11, 4, 7, 30]
    straight, turned = (starts(made(COPTER, boots=2), order) for order in (seeds, [99, *reversed(seeds)]))
    assert np.array_equal(straight, turned[:0:-1])


def test_single_and_vector_environments_begin_alike():
    options = {"robot": COPTER, "world": "open", "take_off": 3.0, "setpoint": "velocity", "boots": 4}
    vector = NavigateVector(num_envs=3, **options)
    single = gym.make("sitl/Navigate-v1", **options)
    seen = vector.reset(seed=[5, 6, 7])[0]
    after = vector.step(np.stack([single.action_space.sample() * 0 for _ in range(3)]))[0]
    for k in (2, 0, 1):
        assert np.array_equal(single.reset(seed=5 + k)[0], seen[k])
        assert np.array_equal(single.step(single.action_space.sample() * 0)[0], after[k])
    vector.close()
    single.close()


def test_begin_boot_boots_with_the_seed_of_the_episode():
    robot = made(COPTER, begin="boot")
    first = starts(robot, [1, 2, 1])
    assert np.array_equal(first[0], first[2]) and not np.allclose(first[0, :7], first[1, :7])


@pytest.mark.parametrize("boots", [0, 1025, 2.5, True, "many"])
def test_other_numbers_are_refused(boots):
    with pytest.raises(EnvOptionError, match=r"boots = .*; a whole number, 1 .. 1024, is needed"):
        made(COPTER, boots=boots)


@pytest.mark.parametrize("walks", [False, True])
def test_the_filter_is_consistent_where_the_receiver_does_not_walk(walks):
    """Mean of squared errors over variances (NEES), within its 95 % band for horizontal position and velocity."""
    still = {"gps_drift_horizontal": 0.0, "gps_drift_vertical": 0.0, "baro_drift": 0.0}
    airframe, found = vehicles.load(COPTER).changed(**({} if walks else still)), []
    robot = made(airframe, begin="boot")
    for seed in range(100, 130):
        robot.reset(0, (0.0, 0.0, 0.0, 0.0), seed)
        p = robot.view(0).autopilot.ekf.P
        found.append(
            [
                e * e / float(p[k, k])
                for e, k in zip(error(robot), (POS, POS + 1, POS + 2, VEL, VEL + 1, VEL + 2), strict=False)
            ]
        )
    place, velocity = np.mean(found, 0)[:2].mean(), np.mean(found, 0)[3:].mean()
    assert 0.73 < velocity < 1.31  # chi-square of 90 numbers; the walk moves the receiver, slowly
    assert place > 40.0 if walks else 0.67 < place < 1.39  # of 60 numbers


@pytest.mark.slow
@pytest.mark.parametrize("frame", [COPTER, ROVER])
def test_a_thousand_seeds_are_distributed_as_real_boots(frame):
    real = starts(made(frame, begin="boot"), range(10_000, 10_200), (0.0, 0.0, 0.0, 0.0))
    drawn, boots = starts(made(frame), range(1000), (0.0, 0.0, 0.0, 0.0)), 64
    for k, name in enumerate(NAMES):
        # Errors of two means and of two standard deviations, at four sigma: what is not drawn anew has 64 boots.
        a, b = real[:, k], drawn[:, k]
        of_drawn = len(b) if name in ("north", "east") else boots
        tails = max(float(((a - a.mean()) ** 4).mean() / a.var() ** 2), 3.0)
        spread = math.sqrt(a.var() * (1 / len(a) + 1 / of_drawn))
        of_spread = a.std() * math.sqrt((tails - 1) / 4 * (1 / len(a) + 1 / of_drawn))
        assert abs(a.mean() - b.mean()) < 4 * spread, name
        assert abs(a.std() - b.std()) < 4 * of_spread, name
