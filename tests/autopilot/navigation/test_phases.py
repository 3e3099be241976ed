# SPDX-License-Identifier: BSD-3-Clause
"""Phases of constant jerk end where they should, as early as ruckig's, and with the same bits on every machine."""

from __future__ import annotations

import hashlib
import math
import random
import struct

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from sitl.autopilot.navigation.leg import Limits, plan
from sitl.autopilot.navigation.phases import State, change_speed, from_motion, from_rest_to_rest, speed_at_rest

speeds = st.one_of(st.just(0.0), st.floats(-10.0, 20.0))
BITS = "89f3a2db6b9ac4d90f479d281551d974c3a21b5e9239e11b4c95d566c2752d6e"
"""SHA-256 over the numbers of ``BIT_LEGS`` legs."""
BIT_LEGS = 400


@given(speeds, st.floats(-5.0, 5.0), speeds, st.floats(0.2, 10.0), st.floats(0.2, 10.0))
@settings(max_examples=100, deadline=None)
def test_a_change_of_speed(v0: float, a0: float, v1: float, acceleration: float, jerk: float) -> None:
    """It ends at the speed and without acceleration, within the limit; never later than two pulses and a hold."""
    phases = change_speed(v0, a0, v1, acceleration, jerk)
    state = State(0.0, v0, a0)
    for phase in phases:
        assert phase.duration > 0.0 and abs(phase.jerk) in (0.0, jerk)
        state = state.after(phase)
        assert abs(state.a) <= max(acceleration, abs(a0)) * (1.0 + 1e-12)
    assert state.v == pytest.approx(v1, abs=1e-9) and state.a == pytest.approx(0.0, abs=1e-9)
    assert len(phases) <= 3


@given(
    st.one_of(st.just(0.0), st.floats(1e-4, 1e4)),
    speeds,
    st.floats(-5.0, 5.0),
    st.one_of(st.just(0.0), st.floats(0.0, 1.0)),
    *[st.floats(0.2, 20.0)] * 3,
)
@settings(max_examples=200, deadline=None)
def test_from_any_motion(
    length: float, v0: float, a0: float, part: float, speed: float, acceleration: float, jerk: float
) -> None:
    """Whatever it begins with, it comes to its end at its speed.

    A peak is a number of 53 bits. Next to the lowest, one bit more of it takes 2 sqrt(bit / jerk) seconds more, and the
    motion leads as far as the speed in these.
    """
    start, v1 = State(0.0, v0, a0), part * speed
    phases = from_motion(length, start, v1, speed, acceleration, jerk)
    states = [start]
    for phase in phases:
        assert phase.duration > 0.0
        states.append(states[-1].after(phase))
    far = max(abs(state.p) for state in states)
    fast = max(abs(state.v) for state in states)
    bit = 2.0 * fast * math.sqrt(math.ulp(fast) / jerk)
    assert states[-1].p == pytest.approx(length, abs=1e-8 + 1e-10 * far + bit)
    assert states[-1].v == pytest.approx(v1, abs=1e-8) and states[-1].a == pytest.approx(0.0, abs=1e-9)
    assert len(phases) <= 7


@pytest.mark.parametrize(
    ("length", "lasts"),
    [
        (2.0, 4.0),  # four pulses of 1 s
        (6.0, 6.0),  # with a hold of 1 s
        (12.0, 8.0),  # to the greatest speed
        (21.0, 11.0),  # and a cruise
    ],
)
def test_from_rest_to_rest(length: float, lasts: float) -> None:
    """Pulses of 1 s with 1 m/s^3, at most 3 m/s: the cases by which limit ends it, at their borders too."""
    phases = from_rest_to_rest(length, 3.0, 1.0, 1.0)
    assert sum(phase.duration for phase in phases) == pytest.approx(lasts, abs=1e-12)
    assert State(0.0, 0.0, 0.0).after_all(phases) == pytest.approx((length, 0.0, 0.0), abs=1e-12)


def drawn(rng: random.Random) -> tuple[float, Limits, float, float, float]:
    """Arguments of a leg: half of them from rest to rest, the rest begun at any speed below the limit."""
    within = Limits(rng.uniform(1.0, 15.0), rng.uniform(0.5, 5.0), rng.uniform(0.5, 5.0), rng.uniform(0.0, 0.5))
    root = rng.uniform(0.2, 10.0)
    length = root * root * root
    if rng.random() < 0.5:
        return length, within, 0.0, 0.0, 0.0
    v0, a0 = rng.uniform(0.0, within.speed), rng.uniform(-1.0, 1.0) * within.acceleration
    return length, within, v0, a0, rng.choice((0.0, rng.uniform(0.0, within.speed)))


def test_plans_have_the_same_bits_everywhere() -> None:
    """A digest of many plans, made on one machine: only sums, products, quotients and roots are taken, whose results
    the floating-point standard prescribes, so that no number can lie on a boundary between two machines."""
    rng, bits = random.Random(32), hashlib.sha256()
    for _ in range(BIT_LEGS):
        profile = plan(*drawn(rng))
        for segment in profile.segments:
            bits.update(struct.pack("<6d", *segment))
        bits.update(struct.pack("<3d", *profile[1:]))
    assert bits.hexdigest() == BITS


def test_as_early_as_ruckig() -> None:
    """Ruckig (L. Berscheid, T. Kroeger, RSS 2021) solves the same problem by roots of polynomials: no leg is slower."""
    ruckig = pytest.importorskip("ruckig")
    rng = random.Random(4)
    for _ in range(300):
        length, within, v0, a0, v1 = drawn(rng)
        _, speed, acceleration, jerk = length, *within[:3]
        if abs(speed_at_rest(v0, a0, jerk)) > speed:
            continue  # ruckig brakes first
        wanted = ruckig.InputParameter(1)
        wanted.current_position, wanted.current_velocity, wanted.current_acceleration = [0.0], [v0], [a0]
        wanted.target_position, wanted.target_velocity, wanted.target_acceleration = [length], [v1], [0.0]
        wanted.max_velocity, wanted.max_acceleration, wanted.max_jerk = [speed], [acceleration], [jerk]
        theirs = ruckig.Trajectory(1)
        ruckig.Ruckig(1).calculate(wanted, theirs)
        ours = from_motion(length, State(0.0, v0, a0), v1, speed, acceleration, jerk)
        lasts, state = sum(phase.duration for phase in ours), State(0.0, v0, a0)
        assert lasts == pytest.approx(theirs.duration, rel=1e-7)
        t = 0.0
        for phase in ours:
            t, state = t + phase.duration, state.after(phase)
            assert state.p == pytest.approx(theirs.at_time(t)[0][0], abs=1e-6)
