# SPDX-License-Identifier: BSD-3-Clause
"""Time-optimal motion along a line in phases of constant jerk, within speed, acceleration and jerk.

Such a motion is a change of speed to a peak, a cruise at it, and a change to the speed at the end; the peak is looked
for between bounds (R. Haschke, E. Weitnauer, H. Ritter: "On-Line Planning of Time-Optimal, Jerk-Limited Trajectories",
IROS 2008). Only sums, products, quotients and square roots are taken, in a fixed order: a plan has the same bits on
every machine, which one from a compiled library's roots of polynomials does not.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from typing import NamedTuple

STEPS = 256
"""More than halvings of an interval can go on."""
NEAR, NEAREST = 4e-15, 1e-12
"""How near to its length a motion is planned to end: as part of it, and at least [m]."""
SHORTEST_PHASE = 1e-9
"""A shorter one is rounding [s]."""

_ROUNDING = 1e-12
"""Acceleration that is left by a phase that takes it away, as part of it: a cruise would multiply it."""


class Phase(NamedTuple):
    """A piece of motion: its duration [s], the jerk at its start [m/s^3], and its constant snap [m/s^4]."""

    duration: float
    jerk: float
    snap: float = 0.0


class State(NamedTuple):
    """Distance [m], speed [m/s] and acceleration [m/s^2] along the line."""

    p: float
    v: float
    a: float

    def after(self, phase: Phase) -> State:
        """The state at the end of a phase that begins here."""
        h, j, s = phase
        a = self.a + h * (j + h * s / 2.0)
        return State(
            self.p + h * (self.v + h * (self.a / 2.0 + h * (j / 6.0 + h * s / 24.0))),
            self.v + h * (self.a + h * (j / 2.0 + h * s / 6.0)),
            a if abs(a) > _ROUNDING * abs(self.a) else 0.0,
        )

    def after_all(self, phases: Sequence[Phase]) -> State:
        """The state at the end of the last of them."""
        state = self
        for phase in phases:
            state = state.after(phase)
        return state


def crossing(low: float, high: float, excess: Callable[[float], float], near: float) -> float:
    """A number between ``low`` and ``high`` whose ``excess`` is at most ``near`` zero, from below at ``low``.

    By the Illinois method (false position), and every third time by halving, so that it always ends.
    """
    below, above, last = excess(low), excess(high), 0
    middle = low
    for k in range(STEPS):
        middle = (low * above - high * below) / (above - below) if above > below else low
        if k % 3 == 2 or not low < middle < high:
            middle = 0.5 * (low + high)
        found = excess(middle)
        if abs(found) <= near or middle in (low, high):
            break
        if found <= 0.0:
            low, below, above, last = middle, found, above * (0.5 if last < 0 else 1.0), -1
        else:
            high, above, below, last = middle, found, below * (0.5 if last > 0 else 1.0), 1
    return middle


def speed_at_rest(v: float, a: float, jerk: float) -> float:
    """Speed [m/s] at which the acceleration is gone, when that is taken away at once."""
    return v + 0.5 * a * abs(a) / jerk


def change_speed(v0: float, a0: float, v1: float, acceleration: float, jerk: float) -> list[Phase]:
    """Phases of the quickest change from speed ``v0`` and acceleration ``a0`` to speed ``v1`` without acceleration."""
    up = 1.0 if v1 >= speed_at_rest(v0, a0, jerk) else -1.0
    a, gain = up * a0, up * (v1 - v0)
    peak = max(math.sqrt(max(jerk * gain + 0.5 * a * a, 0.0)), a, 0.0)
    if peak <= acceleration:
        phases = [Phase((peak - a) / jerk, up * jerk), Phase(peak / jerk, -up * jerk)]
    else:
        to_limit = abs(acceleration - a) / jerk
        towards = jerk if a <= acceleration else -jerk
        gained = 0.5 * to_limit * (a + acceleration) + 0.5 * acceleration * acceleration / jerk
        hold = (gain - gained) / acceleration
        phases = [Phase(to_limit, up * towards), Phase(hold, 0.0), Phase(acceleration / jerk, -up * jerk)]
    return [phase for phase in phases if phase.duration > 0.0]


def from_rest_to_rest(length: float, speed: float, acceleration: float, pulse: float) -> list[Phase]:
    """Phases over ``length`` [m] from rest to rest with jerk pulses of ``pulse`` [s] that reach ``acceleration``."""
    hold = min(
        speed / acceleration - pulse, 0.5 * (math.sqrt(pulse * pulse + 4.0 * length / acceleration) - 3.0 * pulse)
    )
    hold = hold if hold > SHORTEST_PHASE else 0.0
    cruise = length / (acceleration * (pulse + hold)) - (2.0 * pulse + hold)
    jerk = acceleration / pulse
    rise, fall = Phase(pulse, jerk), Phase(pulse, -jerk)
    held, cruised = [Phase(hold, 0.0)] if hold > 0.0 else [], [Phase(cruise, 0.0)] if cruise > SHORTEST_PHASE else []
    return [rise, *held, fall, *cruised, fall, *held, rise]


def from_motion(length: float, start: State, v1: float, speed: float, acceleration: float, jerk: float) -> list[Phase]:
    """Phases over ``length`` [m] from a speed and an acceleration (``start``, at 0 m) to speed ``v1``.

    Where the distance is too short for it, the motion goes beyond the end and comes back, or begins backwards.
    """
    direct = change_speed(start.v, start.a, v1, acceleration, jerk)
    sign = 1.0 if length >= start.after_all(direct).p else -1.0  # more than a change of speed takes, or less
    start, length, v1 = State(0.0, sign * start.v, sign * start.a), sign * length, sign * v1

    def by_peak(peak: float) -> tuple[list[Phase], list[Phase], float]:
        """(phases to the peak, phases from it, how far they lead)"""
        first = change_speed(start.v, start.a, peak, acceleration, jerk)
        second = change_speed(peak, 0.0, v1, acceleration, jerk)
        return first, second, start.after_all((*first, *second)).p

    def late(wait: float) -> list[Phase]:
        """The direct change, begun after a first deceleration has become less for a time."""
        first = Phase(wait, jerk)
        then = start.after(first)
        return [*([first] if wait > 0.0 else []), *change_speed(then.v, then.a, v1, acceleration, jerk)]

    near = max(NEAR * abs(length), NEAREST)
    lowest = max(speed_at_rest(start.v, start.a, jerk), v1)
    highest = max(speed, lowest)
    first, second, reached = by_peak(highest)
    if reached <= length:
        cruise = (length - reached) / highest
        phases = [*first, *([Phase(cruise, 0.0)] if cruise > SHORTEST_PHASE else []), *second]
    elif start.a < 0.0 and lowest > v1 and by_peak(lowest)[2] > length:
        phases = late(crossing(0.0, -start.a / jerk, lambda wait: start.after_all(late(wait)).p - length, near))
    else:
        first, second, _ = by_peak(crossing(lowest, highest, lambda peak: by_peak(peak)[2] - length, near))
        if first and second and first[-1].jerk == second[0].jerk:
            first, second = first[:-1], [Phase(first[-1].duration + second[0].duration, second[0].jerk), *second[1:]]
        phases = [*first, *second]
    return [Phase(t, sign * j, s) for t, j, s in phases]
