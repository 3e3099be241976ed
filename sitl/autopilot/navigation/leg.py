# SPDX-License-Identifier: BSD-3-Clause
"""Plans legs: time-optimal travel along a straight line within speed, acceleration, jerk and snap limits.

The timing of the constant-jerk phases is time-optimal (``phases.py``). A leg that starts and ends at rest is then made
snap-limited: each jerk pulse keeps its duration and its area but rises and falls linearly over ``rise``
seconds. All pulses of such a leg are alike, so the distance and the speeds at their ends do not change.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from typing import NamedTuple

from ...core.elementary import hypot
from ...core.vectors import Vec3
from ...errors import SitlError
from .phases import SHORTEST_PHASE, Phase, State, change_speed, from_motion, from_rest_to_rest, speed_at_rest
from .state import SEGMENTS, Leg

SHORTEST = 1e-4
"""A leg shorter than this [m] has no length."""
MIN_LIMIT = 0.01
"""Floor of the speed [m/s], acceleration [m/s^2] and jerk [m/s^3] that parameters can limit a leg to."""
ASTRAY = 1e6
"""A leg under way that can be brought within its limits only so far beyond its end [m] is not planned."""
MAX_RISE = 100.0
"""Ceiling of the time in which jerk rises [s], whatever parameters say."""


_HALVINGS = 12
_NO_ACCELERATION = 1e-9


class LegError(SitlError, ValueError):
    """A leg that cannot be planned; says which number is wrong."""


class Limits(NamedTuple):
    """Limits along a leg [m/s, m/s^2, m/s^3, s]."""

    speed: float
    acceleration: float
    jerk: float
    rise: float = 0.0
    """Time in which jerk rises from zero to its limit: snap = jerk / rise."""


SLOWING_S = 1.8
"""Time at one speed in the middle of a leg [s] with which ArduPilot finds space for slowing down there."""


def bounded(limits: Limits) -> Limits:
    """Limits that every leg can be planned within: each at least ``MIN_LIMIT``, ``rise`` at most ``MAX_RISE``.

    A client may set a parameter to any value of its range, also to 1e-30. ArduPilot gives no leg at all for such a
    value (an internal error, and the vehicle stands); here it is the floor that counts.
    """
    speed, acceleration, jerk = (max(limit, MIN_LIMIT) for limit in limits[:3])
    return Limits(speed, acceleration, jerk, min(limits.rise, MAX_RISE))


class Segment(NamedTuple):
    """A polynomial piece from time ``t``: distance, speed, acceleration, jerk at its start, and its constant snap."""

    t: float
    p: float
    v: float
    a: float
    j: float
    s: float


class Profile(NamedTuple):
    """Motion along a leg. The last segment is the state at and after the end."""

    segments: tuple[Segment, ...]
    duration: float
    turn_in: float
    """End of the time of greatest acceleration from the start [s]."""
    turn_out: float
    """When the deceleration to the end begins [s]."""


def pulse_acceleration(duration: float, limits: Limits) -> float:
    """Acceleration reached by one jerk pulse of ``duration`` [s]: rise, hold,
    fall (or rise and fall when short).
    """
    if duration >= 2.0 * limits.rise:
        return limits.jerk * (duration - limits.rise)
    return 0.25 * limits.jerk / limits.rise * duration * duration


def pulse_duration(length: float, limits: Limits) -> float:
    """Duration [s] of the jerk pulses of a leg of ``length`` [m] from rest to rest.

    The shortest of the times in which such pulses reach the acceleration, the speed (two pulses) or half
    the length (four pulses).
    """

    def solve(reached: Callable[[float], float], wanted: float) -> float:
        low, high = 0.0, 1.0
        while reached(high) < wanted:
            high *= 2.0
        for _ in range(80):
            middle = 0.5 * (low + high)
            if middle in (low, high):
                break
            low, high = (middle, high) if reached(middle) < wanted else (low, middle)
        return high

    def speed(d: float) -> float:
        return pulse_acceleration(d, limits) * d

    duration = solve(lambda d: pulse_acceleration(d, limits), limits.acceleration)
    if speed(duration) >= limits.speed:  # else that takes longer
        duration = solve(speed, limits.speed)
    if 2.0 * speed(duration) * duration >= length:
        duration = solve(lambda d: 2.0 * speed(d) * d, length)
    return duration


def speed_within(length: float, limits: Limits) -> float:
    """Greatest speed [m/s], at most the limit, that can be reached from rest (or given up) within ``length`` [m]."""
    pulse = pulse_duration(max(length, SHORTEST), limits)
    jerk = pulse_acceleration(pulse, limits) / pulse
    acceleration = limits.acceleration

    def distance(speed: float) -> float:
        full = acceleration * acceleration / jerk
        return (
            0.5 * speed * (speed / acceleration + acceleration / jerk)
            if speed > full
            else speed * math.sqrt(speed / jerk)
        )

    low, high = 0.0, limits.speed
    for _ in range(40):
        middle = 0.5 * (low + high)
        low, high = (middle, high) if distance(middle) < length else (low, middle)
    return low


def plan(length: float, limits: Limits, v0: float = 0.0, a0: float = 0.0, v1: float = 0.0) -> Profile:
    """Profile over ``length`` [m] from speed ``v0`` and acceleration ``a0`` to speed ``v1``.

    Raises:
        LegError: a number is not finite, a limit not positive, the length negative, the speed at the end above the
            limit, or the motion at the start is far outside of the limits.
    """
    for name, value in (*zip(("speed", "acceleration", "jerk"), limits, strict=False),):
        if not (math.isfinite(value) and value > 0.0):
            raise LegError(f"leg: {name} limit {value} must be a positive number")
    if not math.isfinite(length + v0 + a0 + v1 + limits.rise) or length < 0.0 or limits.rise < 0.0:
        raise LegError(f"leg: length {length}, rise {limits.rise} must be 0 or more and speeds {v0}, {v1} finite")
    if v1 > limits.speed:
        raise LegError(f"leg: end speed {v1} must be within the limit {limits.speed}")
    if abs(a0) < _NO_ACCELERATION:
        a0 = 0.0  # next to nothing: a leg from rest is one
    if v0 == 0.0 and a0 == 0.0 and v1 == 0.0:
        if length < SHORTEST:
            return Profile((Segment(0.0, length, 0.0, 0.0, 0.0, 0.0),), 0.0, 0.0, 0.0)
        pulse = pulse_duration(length, limits)
        phases = from_rest_to_rest(length, limits.speed, pulse_acceleration(pulse, limits), pulse)
        if limits.rise > 0.0:
            phases = [piece for phase in phases for piece in _soften(phase, min(limits.rise, 0.5 * pulse))]
        return _profile(phases, length, v0, a0, v1)
    within, start = _with_mean_jerk(length, limits), State(0.0, v0, a0)
    phases = _hasty_phases(length, within, start, v1) or _phases(length, within, start, v1)
    profile = _profile(phases, length, v0, a0, v1)
    farthest = max(abs(segment.p) for segment in profile.segments)
    if farthest > length + ASTRAY:
        raise LegError(f"leg: from {v0} m/s and {a0} m/s^2 it would lead {farthest / 1e3:.0f} km away within {limits}")
    return profile


def _with_mean_jerk(length: float, limits: Limits) -> Limits:
    """Limits whose jerk is the mean of a pulse that rises and falls."""
    pulse = pulse_duration(max(length, SHORTEST), limits)
    top = pulse_duration(max(length, 1e3 * limits.speed * pulse), limits)
    return limits._replace(jerk=pulse_acceleration(top, limits) / top)


def plan_slower(length: float, limits: Limits, start: State, rise: Sequence[Phase], v1: float) -> Profile:
    """Profile over ``length`` [m] of a leg that speeds up (``start``, at 0 m) beyond a speed limit which is new.

    As in ArduPilot what is left of speeding up (``rise``) is flown: only its steady acceleration is cut short. Then it
    slows down, where it would go on for ``SLOWING_S`` at the speed that it came to.

    Raises:
        LegError: it takes too many segments.
    """
    top = start.after_all(rise).v
    phases: list[Phase] = []
    for phase in rise:
        steady = phase.jerk == 0.0 and phase.snap == 0.0
        acceleration = start.after_all(phases).a
        cut = min(max(top - limits.speed, 0.0) / acceleration, phase.duration) if steady and acceleration > 0.0 else 0.0
        top -= cut * acceleration
        if phase.duration > cut:
            phases.append(phase._replace(duration=phase.duration - cut))
    risen = start.after_all(phases)
    left, then, within = length - risen.p, State(0.0, risen.v, 0.0), _with_mean_jerk(length, limits)
    stop = then.after_all(change_speed(then.v, 0.0, v1, within.acceleration, within.jerk)).p
    slowed = _slowing_phases(left, within, then, v1) if left - stop >= SLOWING_S * then.v else []
    phases += slowed or _phases(left, within._replace(speed=max(then.v, limits.speed)), then, v1)
    return _profile(phases, length, start.v, start.a, v1)


def _phases(length: float, limits: Limits, start: State, v1: float) -> list[Phase]:
    return from_motion(length, start, v1, limits.speed, limits.acceleration, limits.jerk)


def _hasty_phases(length: float, limits: Limits, start: State, v1: float) -> list[Phase]:
    """Phases of a leg begun too fast, empty when it is not.

    Where the leg is too short for slowing down to the limit and stopping after, it slows down as far as it
    can: bringing the speed below the limit first would mean to stop early or to fly backwards.
    """
    peak = speed_at_rest(start.v, start.a, limits.jerk)
    if peak <= limits.speed:
        return []
    phases = _slowing_phases(length, limits, start, v1)
    low, high = limits.speed, peak
    for _ in range(0 if phases else _HALVINGS):
        middle = 0.5 * (low + high)
        slowed = _slowing_phases(length, limits._replace(speed=middle), start, v1)
        low, high = (low, middle) if slowed else (middle, high)
        phases = slowed or phases
    return phases or _phases(length, limits._replace(speed=1.001 * peak), start, v1)


def _slowing_phases(length: float, limits: Limits, start: State, v1: float) -> list[Phase]:
    """Phases to the speed limit without dipping below it, then as from there; empty where the leg is too short."""
    slowing = change_speed(start.v, start.a, limits.speed, limits.acceleration, limits.jerk)
    distance = length - start.after_all(slowing).p
    if distance < 0.5 * limits.speed * (limits.speed / limits.acceleration + limits.acceleration / limits.jerk) + 1.0:
        return []
    return slowing + _phases(distance, limits, State(0.0, limits.speed, 0.0), v1)


def _soften(phase: Phase, rise: float) -> list[Phase]:
    """A constant-jerk pulse as rise, hold and fall, with the same duration and area."""
    duration, jerk, _ = phase
    if jerk == 0.0:
        return [phase]
    peak = jerk * duration / (duration - rise)
    pieces = [Phase(rise, 0.0, peak / rise), Phase(duration - 2.0 * rise, peak), Phase(rise, peak, -peak / rise)]
    return [piece for piece in pieces if piece.duration > SHORTEST_PHASE]


def _profile(phases: Sequence[Phase], length: float, v0: float, a0: float, v1: float) -> Profile:
    """Integrates phases to segments and finds where the start's acceleration ends and the final
    deceleration begins.
    """
    segments: list[Segment] = []
    t, state = 0.0, State(0.0, v0, a0)
    for phase in phases:
        segments.append(Segment(t, *state, phase.jerk, phase.snap))
        t += phase.duration
        state = state.after(phase)
    ends = [s.t for s in segments[1:]] + [t]
    turn_out = t
    for k in range(len(segments) - 1, -1, -1):  # backwards over the deceleration to the end
        j = segments[k].j + 0.5 * (ends[k] - segments[k].t) * segments[k].s
        if not (segments[k].a < -1e-9 or j < -1e-9):
            break
        turn_out = segments[k].t
    turn_in = 0.0
    for k, segment in enumerate(segments):
        j = segment.j + 0.5 * (ends[k] - segment.t) * segment.s
        if j < -1e-9 or segment.a < -1e-9:
            break
        turn_in = ends[k]
    segments.append(Segment(t, length, v1, 0.0, 0.0, 0.0))
    if len(segments) > SEGMENTS:
        raise LegError(f"leg: {len(segments)} segments, {SEGMENTS} fit")
    return Profile(tuple(segments), t, min(turn_in, turn_out), turn_out)


def axis_limits(direction: Vec3, horizontal: float, up: float, down: float) -> float:
    """Greatest length of a vector along ``direction`` (unit vector NED) within a horizontal and two vertical limits."""
    ne = hypot(direction.x, direction.y)
    d = abs(direction.z)
    vertical = up if direction.z < 0.0 else down
    return min(horizontal / ne if ne > 1e-9 else math.inf, vertical / d if d > 1e-9 else math.inf)


def write(leg: Leg, profile: Profile, origin: Vec3, direction: Vec3, length: float) -> None:
    """Put a profile into a leg record, at its start and not started."""
    leg.segments, leg.k = len(profile.segments), 0
    leg.started = leg.fast = False
    leg.elapsed, leg.duration = 0.0, profile.duration
    leg.turn_in, leg.turn_out, leg.length = profile.turn_in, profile.turn_out, length
    leg.origin, leg.unit = origin, direction
    for k, segment in enumerate(profile.segments):
        leg.t[k], leg.p[k], leg.v[k], leg.a[k], leg.j[k], leg.s[k] = segment
