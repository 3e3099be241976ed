# SPDX-License-Identifier: BSD-3-Clause
"""Encodes one DataFlash log: rows of samples, and the events between them."""

from __future__ import annotations

import math
from collections.abc import Callable
from functools import partial
from typing import Any, Protocol

import numpy as np

from ...autopilot import rally
from ...autopilot.arming_checks import DISARMED
from ...autopilot.events import EVENT_RING
from ...autopilot.fence import items as fence
from ...autopilot.firmware import Firmware
from ...autopilot.mission.mission import Mission
from ...autopilot.modes import shown
from ...autopilot.params.table import Values
from ..kind import logs_of
from . import bits, board, formats
from .common import EVENT_MESSAGES
from .event_messages import EDGES, HEALTH, HOME, ORIGIN, RESOLVED, SILENCE_US, UNHEALTHY, EventEncoder
from .samples import Samples
from .schedule import Plan

ROWS = 1024
"""Number of samples that are collected before they are encoded."""
EVERY_BIT = 0x7FFFFFFF
VERSION = (4, 7, 0)
"""The ArduPilot whose messages these are."""
_RING, _NAV = "autopilot.events.", "autopilot.modes.nav."
_ORIGINS = (
    (ORIGIN, "autopilot.estimate.origin_set", "autopilot.estimate.origin_"),
    (HOME, "autopilot.home.is_set", "autopilot.home."),
)


class Vehicle(Protocol):
    """The part of the simulation's interface that a log uses."""

    fleet: np.ndarray[Any, Any]
    index: int
    v: Any
    firmware: Firmware
    parameters: Values
    mission: Mission
    before_boot_us: int
    physics: str
    airframe: Any

    @property
    def time_us(self) -> int:
        """Simulated time since the start of the simulation [us]."""
        ...


class LogEncoder:
    """Encodes one boot of a vehicle as the bytes of a log. Call ``begin`` first.

    Args:
        vehicle: the simulation.
        boot_unix_us: Unix time of boot [us].
        bitmask: LOG_BITMASK.
        version: name and version of this program, for MSG and VER.
    """

    def __init__(self, vehicle: Vehicle, boot_unix_us: int, bitmask: int, version: str) -> None:
        self._vehicle, self._version = vehicle, version
        self._boot_unix_us = boot_unix_us
        self._kind = logs_of(vehicle.firmware.name)
        self._simulated = ":" not in vehicle.physics  # elsewhere the record holds no truth
        every = (*EVENT_MESSAGES, *self._kind.messages(EVERY_BIT, boot_unix_us, self._simulated))
        self._described = every
        self._numbers = formats.number_all(every)
        self.events = EventEncoder(self._numbers)
        self._bits = bitmask
        self._notes: list[tuple[int, int, bytes]] = []
        self._missions: list[tuple[int, Mission]] = []
        self._mission = vehicle.mission
        self._last_us = 0
        self._values: dict[str, float] = {}
        """Parameters as they were logged last."""
        self._out: list[bytes] = []
        self._seen = int(vehicle.v.autopilot.events.count)
        self._plan_rows()

    def _plan_rows(self) -> None:
        v = self._vehicle
        self._samples = Samples(v.fleet, v.index, ROWS)
        chosen = self._kind.messages(self._bits, self._boot_unix_us, self._simulated)
        self._plan = Plan(chosen, self._numbers, self._samples)
        self._samples.want(*(each.path for each in (*EDGES, *HEALTH)), _NAV + "command_count", _NAV + "command_seq")
        for _, is_set, prefix in _ORIGINS:
            self._samples.want(is_set, prefix + "lat", prefix + "lon", prefix + "alt")
        self._samples.begin()
        self._samples.take(0)
        self.sampler, self.sampler_address = self._samples.sampler, self._samples.address
        periods = self._plan.periods_us
        self.sampler.period_count = len(periods)
        self.sampler.period_us[: len(periods)] = periods

    # ------------------------------------------------------------------ while the vehicle moves

    def row(self) -> None:
        """Take a sample."""
        self._samples.take(self.sampler.row + 1)
        if self.is_full:
            self.write_rows()

    @property
    def is_full(self) -> bool:
        """Whether there is no space for more samples."""
        return self.sampler.row == ROWS

    def note(self, time_us: int, pack: Callable[..., bytes], *arguments: Any) -> None:
        """Add the message ``pack(time_us, *arguments)`` between the samples; times [us since boot] never go back."""
        self._last_us = time_us = max(time_us, self._last_us)
        data = pack(time_us, *arguments)
        if data:
            self._notes.append((self.sampler.row + 1, time_us, data))

    def text(self, time_us: int, text: str) -> None:
        """Add a status text (MSG); time since boot [us]."""
        self.note(time_us, self.events.text, text)

    def command(self, time_us: int, numbers: tuple[Any, ...]) -> None:
        """Add a client's command (MAVC), see ``board.command``; time since boot [us]."""
        self.note(time_us, partial(self.events.pack, board.COMMANDS.name), *numbers)

    def read_events(self) -> None:
        """Add the events that the autopilot emitted since the last call."""
        v, events = self._vehicle.v, self._vehicle.firmware.events
        ring = v.autopilot.events
        count = int(ring.count)
        for k in range(max(self._seen, count - EVENT_RING), count):
            at = k % EVENT_RING
            code, time_us = int(ring.code[at]), int(ring.time_us[at])
            self._last_us = max(self._last_us, time_us)  # also of what is not logged: nothing after it is earlier
            rows = events[code].rows(v, float(ring.a[at]), float(ring.b[at])) if code in events else ()
            for name, numbers in rows:
                self.note(time_us, partial(self.events.pack, name), *numbers)
            if code == DISARMED:
                self._saved(time_us)
        self._seen = count

    def skip_events_before(self, time_us: int) -> None:
        """Skip events before ``time_us`` [us since boot]; later ones are still read."""
        ring = self._vehicle.v.autopilot.events
        count = int(ring.count)
        self._seen = count
        while self._seen > max(0, count - EVENT_RING) and ring.time_us[(self._seen - 1) % EVENT_RING] >= time_us:
            self._seen -= 1

    def mission_changed(self, time_us: int) -> None:
        """Add all items of the mission; time since boot [us]."""
        self._missions.append((self.sampler.row, self._mission))
        self._mission = self._vehicle.mission
        if self._bits & bits.COMMANDS:
            self.note(time_us, self.events.mission, self._mission.items)
        self.parameter(time_us, "MIS_TOTAL")

    @property
    def mission(self) -> Mission:
        """The mission that was logged last."""
        return self._mission

    def parameter(self, time_us: int, name: str) -> None:
        """Add a parameter that was set; time since boot [us]. Its default is not reported again (not a number)."""
        value = self._values[name] = self._vehicle.parameters[name]
        self.note(time_us, self.events.parameters, [(name, value, math.nan)])

    def _saved(self, time_us: int) -> None:
        """Add the parameters that the vehicle changed itself; it saves them when it disarms. Time since boot [us]."""
        values, always = self._vehicle.parameters, self._kind.saved(self._vehicle.v) if self._kind.saved else ()
        for name, before in self._values.items():
            if name in always or values[name] != before:
                self.parameter(time_us, name)

    def set_bitmask(self, bitmask: int) -> None:
        """Log by another LOG_BITMASK from now on."""
        if bitmask != self._bits:
            self.write_rows()
            self._bits = bitmask
            self._plan_rows()

    # ------------------------------------------------------------------ bytes

    def take_bytes(self) -> bytes:
        """The bytes encoded since the last call."""
        self.write_rows()
        data = b"".join(self._out)
        self._out.clear()
        return data

    @property
    def pending(self) -> int:
        """Number of encoded chunks that ``take_bytes`` has not returned yet."""
        return len(self._out)

    def begin(self, time_us: int) -> None:
        """Encode the head of the log: formats, parameters, version, mode, mission, locations; time since boot [us]."""
        v, pack = self._vehicle, self.events
        self._last_us = time_us
        title, build = self._kind.title, self._kind.build_type
        described = f"{title} V{'.'.join(map(str, VERSION))}-dev ({self._version})"
        version = (0, 0, *VERSION, 0, 0, described.encode()[:64], 0, build, 0, 0, 0)
        modes = v.v.autopilot.modes
        self._values = {p.name: v.parameters[p.name] for p in v.parameters.listed()}
        defaults = [(name, value, v.parameters.default(name)) for name, value in self._values.items()]
        self._out += [
            formats.head(self._described, self._numbers, time_us),
            pack.parameters(time_us, defaults),
            pack.pack("VER", time_us, 3, *version[1:]),
            pack.text(time_us, described),
            pack.text(time_us, f"Airframe: {v.airframe.name}"),
            pack.pack("MODE", time_us, shown(modes), shown(modes), int(modes.reason)),
            pack.mission(time_us, v.mission.items),
            *(pack.pack(name, time_us, *numbers) for name, numbers in fence.rows(v.v) + rally.rows(v.v)),
        ]
        self._samples.turn(0)
        for kind, is_set, prefix in _ORIGINS:
            if self._samples.column(is_set)[0]:
                self._out.append(self._origin(0, kind, prefix, time_us))

    def write_rows(self) -> None:
        """Encode the samples and messages so far."""
        n = self.sampler.row
        if not n and not self._notes:
            return
        self._samples.turn(n)
        self._edges(n)
        self._out.append(self._plan.write(n, self._notes))
        self._notes.clear()
        self._missions.clear()
        self._samples.rows[0] = self._samples.rows[n]
        self.sampler.row = 0

    def _edges(self, n: int) -> None:
        """Messages that follow from changes in the samples: EV, ERR of sensors, ORGN, MISE."""
        column, pack = self._samples.column, self.events.pack
        times = column("time_us")
        for edge in EDGES:
            x = column(edge.path)[: n + 1]
            for k in np.flatnonzero(x[1:] != x[:-1]).tolist():
                number = edge.up if x[k + 1] > x[k] else edge.down
                if number:
                    time_us = int(times[k + 1])
                    self._notes.append((k + 1, time_us, pack("EV", time_us, number)))
        for sensor in HEALTH:
            received = column(sensor.path)[: n + 1]
            silent = (received > 0) & (times[: n + 1] - received > SILENCE_US)
            for k in np.flatnonzero(silent[1:] != silent[:-1]).tolist():
                data = pack("ERR", int(times[k + 1]), sensor.subsystem, UNHEALTHY if silent[k + 1] else RESOLVED)
                self._notes.append((k + 1, int(times[k + 1]), data))
        for kind, is_set, prefix in _ORIGINS:
            moved = np.zeros(n, bool)
            for name in ("lat", "lon", "alt"):
                x = column(prefix + name)[: n + 1]
                moved |= x[1:] != x[:-1]
            for k in np.flatnonzero(moved & (column(is_set)[1 : n + 1] != 0)).tolist():
                time_us = int(times[k + 1])
                self._notes.append((k + 1, time_us, self._origin(k + 1, kind, prefix, time_us)))
        count, seq = column(_NAV + "command_count")[: n + 1], column(_NAV + "command_seq")
        for k in np.flatnonzero(count[1:] != count[:-1]).tolist():
            self._command_started(k + 1, int(seq[k + 1]), int(times[k + 1]))

    def _command_started(self, row: int, seq: int, time_us: int) -> None:
        """MISE: a navigation command starts."""
        mission = next((mission for until, mission in self._missions if row <= until), self._mission)
        item = mission.get(seq)
        if item is not None and seq > 0 and self._bits & bits.COMMANDS:
            data = self.events.command("MISE", time_us, len(mission), seq, item)
            self._notes.append((row, time_us, data))

    def _origin(self, row: int, kind: int, prefix: str, time_us: int) -> bytes:
        numbers = (float(self._samples.column(prefix + name)[row]) for name in ("lat", "lon", "alt"))
        return self.events.origin(time_us, kind, *numbers)
