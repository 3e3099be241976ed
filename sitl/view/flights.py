# SPDX-License-Identifier: BSD-3-Clause
"""Flights that were kept (``sitl.logs.track``), as frames of any of their moments, and what happened in them."""

from __future__ import annotations

import math
from bisect import bisect_right
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
import numpy.typing as npt

from .. import vehicles
from ..core.algebra import quat_from_euler
from ..core.vectors import Euler, Vec3
from ..logs.track import Track
from ..vehicle.kinds import KINDS
from . import kind
from .frame import LOG, Frame, Reported
from .shape import ROTOR, Shape

_TURNING = 120.0
"""Speed at which rotors are drawn while it is armed: tracks keep none [rad/s]."""
Floats = npt.NDArray[np.float64]


class Event(NamedTuple):
    """Something that happened."""

    time: float
    """Since the flight's beginning [s]."""
    text: str


@dataclass(frozen=True, eq=False)
class Flight:
    """A flight that can be shown."""

    name: str
    track: Track
    """Its clock is common to all flights that are shown together."""
    shape: Shape
    rolled: Floats
    """Distance over the ground until each sample, for wheels [m], shape (n,)."""

    @property
    def length(self) -> float:
        """When it ends [s]."""
        return float(self.track.t[-1])

    def positions(self) -> Floats:
        """All positions in the scene's axes, shape (n, 3) [m]."""
        return np.column_stack([self.track["north"], -self.track["east"], -self.track["down"]])

    def mode(self, time: float) -> str:
        """The mode at a time [s]."""
        at = bisect_right([t for t, _ in self.track.modes], time)
        return self.track.modes[max(at - 1, 0)][1] if self.track.modes else ""

    def is_armed(self, time: float) -> bool:
        """Whether it is armed at a time [s]; a flight that never says so is."""
        before = [state for t, state in self.track.armed if t <= time]
        return before[-1] if before else not any(state for _, state in self.track.armed)

    def frame(self, time: float) -> Frame:
        """Its state at a time [s], straight between samples."""
        track = self.track

        def of(name: str) -> float:
            return float(np.interp(time, track.t, track[name]))

        yaw = float(np.interp(time, track.t, np.unwrap(track["yaw"])))
        armed, rotors = self.is_armed(time), [piece for piece in self.shape.pieces if piece.turns == ROTOR]
        rolled = float(np.interp(time, track.t, self.rolled))
        return Frame(
            time_us=round(time * 1e6),
            pos=Vec3(of("north"), of("east"), of("down")),
            q=quat_from_euler(Euler(of("roll"), of("pitch"), yaw)),
            vel=Vec3(of("vn"), of("ve"), of("vd")),
            reported=Reported(
                by=LOG, height=-of("down"), position=(of("north"), of("east")), speed=math.hypot(of("vn"), of("ve")),
                climb=-of("vd"), heading=math.degrees(yaw) % 360.0, roll=of("roll"), pitch=of("pitch"),
            ),
            home=Vec3(0.0, 0.0, 0.0), mode=self.mode(time), armed=armed, ready=True,
            rotors=tuple((_TURNING if k % 4 < 2 else -_TURNING) * armed for k in range(len(rotors))),
            rolled=(rolled, rolled),
        )  # fmt: skip

    def events(self) -> list[Event]:
        """Changes of mode and arming, items reached, and texts that warn, in their order."""
        track = self.track
        found = [Event(t, f"mode {mode}") for t, mode in track.modes]
        found += [Event(t, "armed" if state else "disarmed") for t, state in track.armed]
        found += [Event(t, f"item {seq} reached") for t, seq in track.items]
        found += [Event(t, text) for t, severity, text in track.texts if severity <= 4]
        return sorted(event for event in found if 0.0 <= event.time <= self.length)


def of_track(name: str, track: Track, frame: str | None = None) -> Flight:
    """A track as a flight.

    Args:
        name: under which it is shown.
        track: with its clock.
        frame: name of the airframe; None: the usual one of its kind.
    """
    shape = kind.shape_of(vehicles.load(frame or KINDS[track.kind].default_frame))
    speed = np.hypot(track["vn"], track["ve"])
    rolled = np.concatenate([[0.0], np.cumsum(0.5 * (speed[1:] + speed[:-1]) * np.diff(track.t))])
    return Flight(name, track, shape, rolled)
