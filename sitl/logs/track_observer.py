# SPDX-License-Identifier: BSD-3-Clause
"""Takes the track of a simulated vehicle while it flies."""

from __future__ import annotations

import hashlib
from array import array
from collections.abc import Callable
from typing import Any, Protocol

import numpy as np

from ..autopilot.arming_checks import ARMED, DISARMED
from ..autopilot.events import EVENT_RING
from ..autopilot.modes import MODE_CHANGED, shown
from ..core.geodesy import offset_ne
from .track import Track
from .track_columns import COLUMNS, LONGEST_S, STEP_US

BITS_US = 10_000_000
"""Simulated time between two digests of a flight's bits [us]."""
BITS_BYTES = 8
"""Length of one."""
NOWHERE = 1e6
"""Stands for what is no number: nothing else is as far away."""


class Observed(Protocol):
    """The part of the simulation's interface that an observer uses."""

    fleet: np.ndarray[Any, Any]
    index: int
    v: Any
    firmware: Any
    observers: list[Any]
    bridge: Any
    before_boot_us: int

    @property
    def time_us(self) -> int:
        """Simulated time since the start of the simulation [us]."""
        ...


def _reader(simulation: Observed, path: str) -> Callable[[], list[Any]]:
    """A function that reads a field of the vehicle's record, as a list."""
    memory = simulation.fleet
    for name in path.split("."):
        memory = memory[name]
    here: Callable[[], list[Any]] = memory[simulation.index : simulation.index + 1].reshape(-1).tolist
    return here


class TrackObserver:
    """An observer of a simulation and a listener of its bridge; it puts itself there.

    Samples are the autopilot's estimate at whole tenths of a second, from when the estimator has an origin, for as long
    as a track may be (``LONGEST_S``). Nothing in the vehicle changes by it.
    """

    def __init__(self, simulation: Observed) -> None:
        self._vehicle = simulation
        self._pos, self._vel = (_reader(simulation, f"autopilot.estimate.{name}") for name in ("pos", "vel"))
        self._energy = _reader(simulation, "autopilot.battery.consumed_wh")
        self._ready = _reader(simulation, "autopilot.estimate.origin_set")
        self._events = _reader(simulation, "autopilot.events.count")
        self._rows = array("d")
        """Row after row: in a long flight, a fifth of the memory that tuples take."""
        self._bits, self._hash = bytearray(), hashlib.blake2b(digest_size=BITS_BYTES)
        self._bits_us = BITS_US
        self._modes: list[tuple[float, str]] = []
        self._items: list[tuple[float, int]] = []
        self._texts: list[tuple[float, int, str]] = []
        self._armed: list[tuple[float, bool]] = []
        self._seen = 0
        self._boot_us = simulation.before_boot_us
        self._location: tuple[int, int, float] | None = None
        """Origin that rows are counted from [degE7, degE7, m]."""
        self._shift = (0.0, 0.0, 0.0)
        """Vector from the home to the origin since the last boot [m]."""
        self._found_home: tuple[float, float, float] | None = None
        self._is_new = True
        self._note_mode(simulation.time_us * 1e-6, int(shown(simulation.v.autopilot.modes)))
        self._armed.append((simulation.time_us * 1e-6, bool(simulation.v.autopilot.arming.armed)))
        (self._seen,) = self._events()
        self.due_us = -(-simulation.time_us // STEP_US) * STEP_US
        simulation.observers.append(self)
        simulation.bridge.listeners.append(self)

    # ------------------------------------------------------------------ as an observer

    def observe(self) -> None:
        """Take a sample."""
        now = self._vehicle.time_us
        self.due_us = (now // STEP_US + 1) * STEP_US
        if self._vehicle.before_boot_us != self._boot_us:
            self._rebooted()
        self._follow_events()
        if self._ready() == [0]:
            return
        if self._rows and now * 1e-6 - self._rows[0] > LONGEST_S:
            return
        if self._is_new:
            self._find_origin()
        position = [x + shift for x, shift in zip(self._pos(), self._shift)]
        euler = self._vehicle.v.autopilot.estimate.euler
        row = array("d", (now * 1e-6, *position, *self._vel(), *euler, *self._energy()))
        self._rows.extend(row)
        while now >= self._bits_us:
            self._bits += self._hash.digest()
            self._bits_us += BITS_US
        self._hash.update(row.tobytes())

    def _rebooted(self) -> None:
        self._boot_us, self._seen, self._is_new = self._vehicle.before_boot_us, 0, True
        self._note_armed(self._boot_us * 1e-6, False)

    def _find_origin(self) -> None:
        estimate = self._vehicle.v.autopilot.estimate
        lat, lon, alt = int(estimate.origin_lat), int(estimate.origin_lon), float(estimate.origin_alt)
        if self._location is None:
            self._location = (lat, lon, alt)
        self._shift = (*offset_ne(self._location[0], self._location[1], lat, lon), self._location[2] - alt)
        self._is_new = False

    def _follow_events(self) -> None:
        (count,) = self._events()
        if count == self._seen:
            return
        ring = self._vehicle.v.autopilot.events
        for number in range(max(self._seen, count - EVENT_RING), count):
            k = number % EVENT_RING
            time = (self._boot_us + int(ring.time_us[k])) * 1e-6
            code = int(ring.code[k])
            if code == MODE_CHANGED:
                self._note_mode(time, int(ring.a[k]))
            elif code in (ARMED, DISARMED):
                self._note_armed(time, code == ARMED)
        self._seen = count

    def _note_mode(self, time: float, number: int) -> None:
        name = self._vehicle.firmware.mode_names.get(number, str(number))
        if not self._modes or self._modes[-1][1] != name:
            self._modes.append((time, name))

    def _note_armed(self, time: float, state: bool) -> None:
        if not self._armed or self._armed[-1][1] != state:
            self._armed.append((time, state))
        if state and self._found_home is None:
            self._found_home = self._present_home()

    def _present_home(self) -> tuple[float, float, float] | None:
        home = self._vehicle.v.autopilot.home
        return (int(home.lat) * 1e-7, int(home.lon) * 1e-7, float(home.alt)) if home.is_set else None

    # ------------------------------------------------------------------ as a listener

    def said(self, severity: int, text: str) -> None:
        """The vehicle told its clients something."""
        self._texts.append((self._vehicle.time_us * 1e-6, severity, text))

    def commanded(self, fields: Any, frame: int, is_location: bool, sender: tuple[int, int], result: int) -> None:
        """Not part of a track."""

    def parameter_set(self, name: str) -> None:
        """Not part of a track."""

    def reached(self, seq: int) -> None:
        """A mission item was reached."""
        self._items.append((self._vehicle.time_us * 1e-6, seq))

    # ------------------------------------------------------------------ the track

    def track(self) -> Track:
        """The track so far."""
        self._follow_events()
        data = np.array(self._rows).reshape(-1, len(COLUMNS))
        data = np.nan_to_num(data, nan=NOWHERE, posinf=NOWHERE, neginf=-NOWHERE)
        lat, lon, alt = self._location or (0, 0, 0.0)
        origin = (lat * 1e-7, lon * 1e-7, alt)
        home = self._found_home or self._present_home() or origin
        track = Track(
            self._vehicle.firmware.name,
            data,
            origin,
            list(self._modes),
            list(self._items),
            list(self._texts),
            list(self._armed),
        )
        return track.seen_from(home)

    def bits(self) -> bytes:
        """Digests of all samples to their last bit, up to each ten seconds and to the end: a section of a recording.

        They say whether two flights are the same where a track, which is rounded, cannot, and since when they are not.
        They do not depend on what else the vehicle's record holds, and so not on the version of the simulator.
        """
        return bytes(self._bits) + self._hash.digest()

    def to_bytes(self) -> bytes:
        """``track().to_bytes()``: a section of a recording (``recorder.sections["track"]``)."""
        return self.track().to_bytes()
