# SPDX-License-Identifier: BSD-3-Clause
"""What stands between an agent and a vehicle at a connection: limits, a geofence, a watch on the agent's rate, and the
hand-over to the vehicle's own modes when the agent is late, done or in doubt.

The vehicle's own failsafes stay what they are. When this process dies without a word (SIGKILL, a crash, no power, no
link), a vehicle in GUIDED stops by itself after GUID_TIMEOUT, 3 s, and FS_GCS_ENABLE acts on the heartbeats that come
no more.
"""

from __future__ import annotations

import contextlib
import errno
import json
import math
import os
import sys
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, fields
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np

from sitl.core.elementary import cos, hypot, sin
from sitl.core.sums import lengths, products

from ..actions import ACCELERATION, ATTITUDE, POSITION, VELOCITY, Setpoint
from ..options import EnvOptionError

AHEAD_S, BRAKING = 3.0, 2.0
"""The speed towards the fence is one that, kept for 3 s (GUID_TIMEOUT: the agent dies without a word) and
then braked at 2 m/s^2, ends at the fence."""
BEYOND = 2.0
"""So far outside of the fence the agent is not in charge any more [m]."""
NOT_HANDED_OVER = "not handed over"
"""What a guard has done (``Deed``) when the vehicle is not known to be in its mode."""
GUARDED = (VELOCITY, POSITION, ATTITUDE, ACCELERATION)
"""Set-points with limits."""


@dataclass(frozen=True)
class Guard:
    """Limits of an agent on a vehicle.

    Args:
        radius: of the fence about the position where the vehicle was when the environment took it over [m].
        floor, ceiling: heights above the ground there between which a copter stays [m]. A floor of 0 or less lets it
            land: speeds shrink within some 5 m of the floor, so -5 leaves them as they are.
        speed, climb: greatest speeds, horizontal and vertical [m/s].
        tilt: greatest roll and pitch of attitude set-points [rad].
        acceleration: greatest, of acceleration set-points [m/s^2].
        late: wall time between two steps after which the agent is late [s].
        hand_over: mode that takes over; "": BRAKE for a copter, HOLD for a rover.
        log: file that gets a line (JSON) for each thing that was done; None: none. One that cannot be opened is refused
            when the environment is made; one that cannot be written later ends nothing.
    """

    radius: float = 50.0
    floor: float = 1.0
    ceiling: float = 30.0
    speed: float = 3.0
    climb: float = 1.5
    tilt: float = 0.35
    acceleration: float = 2.0
    late: float = 1.0
    hand_over: str = ""
    log: str | Path | None = None

    def __post_init__(self) -> None:
        for field in fields(self):
            value = getattr(self, field.name)
            if field.type != "float":
                continue
            low = -math.inf if field.name == "floor" else 0.0
            if not (isinstance(value, int | float) and low < value < math.inf):
                raise EnvOptionError(f"Guard({field.name}={value!r}); it must be {'finite' if low else 'above 0'}")
        if self.floor >= self.ceiling:
            raise EnvOptionError(f"Guard(floor={self.floor}, ceiling={self.ceiling}); the floor must be the lower one")


class Deed(NamedTuple):
    """Something that a guard has done."""

    time: float
    """Of the vehicle, since its boot [s]."""
    what: str
    """"taken over", "limited", "take-off", "put down", "handed over", "not handed over" or "log lost"."""
    why: str


class Watch:
    """A guard at work.

    Args:
        guard: the limits.
        flies: whether heights count.
        clock: wall time [s].
    """

    def __init__(self, guard: Guard, flies: bool, clock: Callable[[], float]) -> None:
        self.guard, self._flies, self._clock = guard, flies, clock
        self.deeds: list[Deed] = []
        """All that was done, in order."""
        self.in_charge = False
        """Whether the agent's set-points reach the vehicle."""
        self.reason = ""
        """Why it is not."""
        self._centre = np.zeros(3)
        self._limited = self._log_is_lost = False
        self._seen: float | None = None

    def take_over(self, time: float, position: Sequence[float]) -> None:
        """The agent is in charge from now on. The first position (x, y, z [m]) is the middle of the fence."""
        if not self.deeds:
            self._centre = np.array(position, np.float64)
        self.in_charge, self.reason, self._limited, self._seen = True, "", False, None
        self.note(time, "taken over", "")

    def give_up(self, why: str) -> None:
        """The agent is not in charge any more. It is noted later: the vehicle comes first."""
        self.in_charge, self.reason = False, why

    def doubt(self, pose: Sequence[float], row: Sequence[float]) -> str:
        """Why the agent must not go on: it is late, its set-point is no number, the vehicle is outside; "": it may.

        Args:
            pose: x, y, z [m], yaw [rad] of the vehicle.
            row: set-point.
        """
        now, before = self._clock(), self._seen
        if before is not None and now - before > self.guard.late:
            return f"the agent is late: {now - before:.2f} s since its last step"
        if not all(map(math.isfinite, row)):
            return f"a set-point is no number: {list(row)}"
        away = hypot(pose[0] - self._centre[0], pose[1] - self._centre[1])
        if away > self.guard.radius + BEYOND:
            return f"outside of the fence: {away:.1f} m away"
        if self._flies and not self.guard.floor - BEYOND < pose[2] < self.guard.ceiling + BEYOND:
            return f"outside of the fence: at a height of {pose[2]:.1f} m"
        return ""

    def stepped(self) -> None:
        """A step is over: the agent's time counts from now."""
        self._seen = self._clock()

    def limited(self, setpoint: Setpoint, row: Sequence[float], pose: Sequence[float], time: float) -> list[float]:
        """The set-point within the limits.

        Raises:
            EnvOptionError: a kind that has none.
        """
        if setpoint not in GUARDED:
            names = ", ".join(kind.name for kind in GUARDED)
            raise EnvOptionError(f"setpoint {setpoint.name!r} is for simulators: a guard can limit {names} only")
        given = [float(number) for number in row]
        rule = {VELOCITY: self._velocity, POSITION: self._position, ATTITUDE: self._attitude}
        out = rule.get(setpoint, self._acceleration)(list(given), pose)
        is_limited = any(abs(a - b) > 1e-9 for a, b in zip(out, given))
        if is_limited and not self._limited:
            said, kept = ([round(number, 3) for number in numbers] for numbers in (given, out))
            self.note(time, "limited", f"{setpoint.name} {said} to {kept}")
        self._limited = is_limited
        return out

    def _velocity(self, row: list[float], pose: Sequence[float]) -> list[float]:
        guard, yaw = self.guard, pose[3]
        size = hypot(row[0], row[1])
        share = min(1.0, guard.speed / size) if size > 0.0 else 1.0
        c, s = cos(yaw), sin(yaw)
        v = np.array([row[0] * c - row[1] * s, row[0] * s + row[1] * c]) * share
        offset = np.array(pose[:2]) - self._centre[:2]
        distance = float(lengths(offset))
        if distance > 0.0:
            outward = offset / distance
            v = v - max(float(products(v, outward)) - _speed_within(guard.radius - distance), 0.0) * outward
        up = min(max(row[2], -guard.climb), guard.climb)
        if self._flies:
            up = min(max(up, -_speed_within(pose[2] - guard.floor)), _speed_within(guard.ceiling - pose[2]))
        return [float(v[0] * c + v[1] * s), float(v[1] * c - v[0] * s), up, *row[3:]]

    def _position(self, row: list[float], pose: Sequence[float]) -> list[float]:
        guard, offset = self.guard, np.array(row[:2]) - self._centre[:2]
        share = min(1.0, guard.radius / max(float(lengths(offset)), 1e-9))
        x, y = (self._centre[:2] + share * offset).tolist()
        return [x, y, min(max(row[2], guard.floor), guard.ceiling) if self._flies else row[2], *row[3:]]

    def _attitude(self, row: list[float], pose: Sequence[float]) -> list[float]:
        tilt = self.guard.tilt
        return [min(max(row[0], -tilt), tilt), min(max(row[1], -tilt), tilt), *row[2:]]

    def _acceleration(self, row: list[float], pose: Sequence[float]) -> list[float]:
        most = self.guard.acceleration
        return [*(min(max(number, -most), most) for number in row[:3]), *row[3:]]

    def note(self, time: float, what: str, why: str) -> None:
        """Add a deed, at a time of the vehicle [s]. A log that cannot be written is reported, once,
        and ends nothing."""
        deed = Deed(round(time, 3), what, why)
        self.deeds.append(deed)
        if self.guard.log is None:
            return
        try:
            append(self.guard.log, json.dumps(deed._asdict()) + "\n")
        except (OSError, ValueError) as error:
            if not self._log_is_lost:
                self._log_is_lost = True
                fault = getattr(error, "strerror", "") or error
                text = f"guard: log {str(self.guard.log)!r} cannot be written: {fault}"
                self.deeds.append(Deed(deed.time, "log lost", text))
                say(f"{text}; the flight goes on without it")


def append(path: str | Path, text: str) -> None:
    """Add to a file, which is made if it is not there. Waits for nobody who reads it.

    Raises:
        OSError: it cannot be written, or not all of it.
    """
    flags = os.O_WRONLY | os.O_APPEND | os.O_CREAT | getattr(os, "O_NONBLOCK", 0)
    file = os.open(path, flags, 0o666)
    try:
        data = text.encode()
        if data and os.write(file, data) < len(data):
            raise OSError(errno.ENOSPC, os.strerror(errno.ENOSPC))
    finally:
        os.close(file)


def say(text: str) -> None:
    """On standard error, if anybody is there: it stops nothing."""
    with contextlib.suppress(Exception):
        print(f"sitl: {text}", file=sys.stderr, flush=True)


def _speed_within(clearance: float) -> float:
    """Greatest speed [m/s] towards a fence that is so far away [m]; outside of it one that leads back."""
    if clearance <= 0.0:
        return clearance
    return BRAKING * (math.sqrt(AHEAD_S * AHEAD_S + 2.0 * clearance / BRAKING) - AHEAD_S)


def guard_of(option: Any, is_simulator: bool) -> Guard | None:
    """The guard that an option means: None is ``Guard()`` for what may be a real vehicle, and none for a simulator;
    False is none at all.

    Raises:
        EnvOptionError: the option is none of these, nor a ``Guard``, nor a mapping of its arguments.
    """
    if option is None:
        return None if is_simulator else Guard()
    if option is False:
        return None
    if isinstance(option, Guard):
        return option
    if isinstance(option, Mapping):
        try:
            return Guard(**option)
        except TypeError as error:
            raise EnvOptionError(
                f"guard: {error}; there are {', '.join(field.name for field in fields(Guard))}"
            ) from None
    raise EnvOptionError(f"guard = {option!r}; it must be a Guard, its arguments, False, or None")
