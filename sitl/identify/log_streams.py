# SPDX-License-Identifier: BSD-3-Clause
"""A log as what an identification needs: when the vehicle moved by itself and as usual, and its streams."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np

from ..errors import SitlError
from ..logs import forms
from ..logs.dataflash.columns import Columns, Progress
from ..logs.dataflash.tables import Table, Tables
from ..logs.tlog_columns import Telemetry
from .expected import Conditions
from .signals import Span, increasing, within

Array = np.ndarray[Any, Any]

_ARMED, _DISARMED, _LANDED, _NOT_LANDED = 10, 11, 18, 28
"""EV.Id"""
_MAYBE_LANDED = 17
_FAILSAFES = {5: "radio", 6: "battery", 8: "GCS", 12: "crash", 16: "EKF", 17: "EKF", 18: "barometer", 29: "vibration"}
"""ERR.Subsys whose errors end what counts as a usual flight, until their ECode is 0."""
_SETTLES_S = 3.0
"""After take-off and before landing [s]."""
ABOVE_M = 2.0
"""Nearer to the ground than this the rotors' air comes back [m]."""
_DRIVES = 0.1
"""A rover that never drove faster stood [m/s]."""
_KINDS = ("copter", "rover")
_NAMES = (
    "ARM", "BARO", "BAT", "CTUN", "ERR", "EV", "GPS", "IMU", "MAG", "MOTB", "PSCE", "PSCN", "RCOU", "VIBE", "XKF1",
    "XKF4", "NKF1", "NKF4", "CURR",
)  # fmt: skip
_FAST = {
    "ATT": ("DesRoll", "Roll", "DesPitch", "Pitch", "DesYaw", "Yaw", "AEKF"),
    "RATE": ("R", "ROut", "P", "POut", "Y", "YOut", "AOut"),
}
"""Messages of which there may be hundreds a second, and what of them is used."""
_OLDEST = {"copter": (3, 4), "rover": (4, 0)}
"""Version whose messages have the units of today's; rovers before 4 had another speed controller and outputs."""
_READ = "logs of ArduPilot are read: on-board ones (.bin, .log), and telemetry (.tlog)"
_NO_PARAMETERS = (
    "has no PARM, which say what its outputs mean: it begins in the middle, or its start is damaged",
    "has no parameters (PARAM_VALUE, or @PARAM/param.pck by FTP), which say what its outputs mean: it began after the "
    "ground station had got them. Get them again while it is recorded, or take the on-board log (.bin)",
)
"""Of a DataFlash log, of telemetry."""


class IdentifyError(SitlError, ValueError):
    """A log of which no airframe can be made; the message names it and says why."""


class FlightLog:
    """A log.

    Args:
        path: of a .bin, a .log as text, or a .tlog.
        progress: called with how far it is read.
        above: height over the ground from which on a copter's flight counts [m].

    Raises:
        sitl.logs.tlog.LogError: it cannot be read, or is of a vehicle that the simulator does not have.
        IdentifyError: it has no parameters, or the vehicle never moved.
    """

    def __init__(self, path: str | Path, progress: Progress | None = None, above: float = ABOVE_M) -> None:
        self.path, self._above = Path(path), above
        self.columns = self._read(progress)
        self.kind = self.columns.kind
        if self.kind not in _KINDS:
            raise IdentifyError(f"log {str(path)!r} is of a {self.kind}; {' and '.join(_KINDS)}s are identified")
        if self.columns.helicopter:
            raise IdentifyError(
                f"log {str(path)!r} is of a helicopter ({self.columns.helicopter}); copters with rotors of fixed pitch "
                "are identified"
            )
        oldest = _OLDEST[self.kind]
        if (self.columns.version or oldest) < oldest:
            raise IdentifyError(
                f"log {str(path)!r} is of {self.columns.firmware}; logs of {self.kind}s are identified from ArduPilot "
                f"{oldest[0]}.{oldest[1]} on, older ones have other messages and units (sitl view takes them, "
                "sitl twin those with EKF1)"
            )
        self._estimate = self.columns.estimate
        self.columns.alias("XKF1", self._estimate)
        self.columns.alias_battery()
        if self.is_telemetry and self.kind != "copter":
            raise IdentifyError(
                f"log {str(path)!r} is telemetry of a {self.kind}, which tells too little of it; "
                "take the on-board log (.bin)"
            )
        self.parameters = self.columns.parameters
        if not self.parameters:
            raise IdentifyError(f"log {str(path)!r} {_NO_PARAMETERS[self.is_telemetry]}")
        self.armed = self._armed()
        self.spans = self._flying() if self.kind == "copter" else self._driving()
        """When it moved by itself, without failsafe."""
        if not self.spans:
            where = (
                f"in the air, {above:g} m over the ground"
                if self.kind == "copter"
                else f"armed and driving (XKF1 over {_DRIVES:g} m/s)"
            )
            raise IdentifyError(
                f"log {str(path)!r}: the vehicle was never {where} for {4 * _SETTLES_S:.0f} s without failsafe"
            )

    def _read(self, progress: Progress | None) -> Tables:
        form = forms.of(self.path)
        if form == forms.TLOG:
            return Telemetry(self.path, progress)
        if form != forms.DATAFLASH:
            raise IdentifyError(f"log {str(self.path)!r} is {form}; {_READ}")
        return Columns(self.path, {**dict.fromkeys(_NAMES), **_FAST}, progress)

    @property
    def is_telemetry(self) -> bool:
        """Whether it is what the vehicle sent, not what it kept."""
        return isinstance(self.columns, Telemetry)

    @property
    def notes(self) -> list[str]:
        """What is wrong with the file, and was passed over."""
        log, found = self.columns, []
        if isinstance(log, Telemetry):
            found += [f"{log.bad} frames with a wrong checksum are left out"] * (log.bad > 0)
        elif isinstance(log, Columns):
            found += [f"{log.skipped} bytes are no messages: the log is damaged there"] * (log.skipped > 0)
            found += ["it is cut off within a message"] * log.truncated
        found += ["NKF1 (EK2) stands for XKF1: the vehicle flew by it"] * (self._estimate == "NKF1")
        found += [f"{log.left_out} messages with times that cannot be are left out"] * (log.left_out > 0)
        if self.armed and self.armed[-1].end >= self._end:
            found.append("it ends while the vehicle is armed: it is read up to there")
        return [f"{self.path.name}: {note}" for note in found]

    @property
    def seconds(self) -> float:
        """How long it moved [s]."""
        return sum(span.length for span in self.spans)

    def parameter(self, *names: str, default: float) -> float:
        """The first of these that the log has, under the names of several versions."""
        return next((self.parameters[name] for name in names if name in self.parameters), default)

    def has(self, *names: str) -> bool:
        """Whether it has messages of all these names."""
        return all(name in self.columns for name in names)

    def stream(self, name: str, instance: int | None = None) -> Table:
        """Messages of a name, or of one sensor of these, in the order of their times."""
        table = self.columns[name] if instance is None else self.columns[name].instance(instance)
        later = increasing(table.time)
        return table if later.all() else table.where(later)

    def estimate(self) -> Table:
        """XKF1, or NKF1, of the lane that was flown by."""
        table = self.columns.lane(self._estimate)
        return table.where(increasing(table.time))

    # ------------------------------------------------------------------

    def _events(self, begin: tuple[int, ...], end: tuple[int, ...]) -> list[Span]:
        """From each event that begins to the next one that ends."""
        if not self.has("EV"):
            return []
        spans, since = [], None
        for time, event in zip(self.columns["EV"].time.tolist(), self.columns["EV"]["Id"].astype(int).tolist()):
            if event in begin:
                since = time if since is None else since
            elif event in end and since is not None:
                spans.append(Span(since, time))
                since = None
        if since is not None:
            spans.append(Span(since, self._end))
        return spans

    @property
    def _end(self) -> float:
        return max(float(self.columns[name].time[-1]) for name in self.columns if len(self.columns[name].time))

    def _armed(self) -> list[Span]:
        if found := self._events((_ARMED,), (_DISARMED,)):
            return found
        if self.has("ARM") and "ArmState" in self.columns["ARM"]:
            spans, since = [], None
            for time, state in zip(self.columns["ARM"].time.tolist(), self.columns["ARM"]["ArmState"].tolist()):
                if state and since is None:
                    since = time
                elif not state and since is not None:
                    spans.append(Span(since, time))
                    since = None
            return spans + ([Span(since, self._end)] if since is not None else [])
        # A log begins with the arming, unless it is kept while disarmed, too.
        if self.parameter("LOG_DISARMED", default=0.0) == 0.0 and self.has("ATT"):
            return [Span(float(self.columns["ATT"].time[0]), self._end)]
        return []

    def _flying(self) -> list[Span]:
        """In the air, high enough, without failsafe."""
        found = self._events((_NOT_LANDED,), (_LANDED, _MAYBE_LANDED, _DISARMED)) or self.armed
        spans = [Span(span.begin + _SETTLES_S, span.end - _SETTLES_S) for span in found]
        spans = [span for span in spans if span.length > 0.0]
        spans = _without(spans, self._failsafes())
        spans = _without(spans, self._near_ground(found))
        return [span for span in spans if span.length > 2.0 * _SETTLES_S]

    def _driving(self) -> list[Span]:
        """Armed, without failsafe: a rover that stands tells that its outputs do not move it."""
        spans = _without(self.armed, self._failsafes())
        return [span for span in spans if span.length > 2.0 * _SETTLES_S and self._fastest(span) > _DRIVES]

    def _fastest(self, span: Span) -> float:
        """Greatest speed over the ground in a span [m/s]."""
        if not self.has("XKF1"):
            return 0.0
        table = self.estimate()
        table = table.where(within(table.time, [span]))
        return float(np.hypot(table["VN"], table["VE"]).max()) if len(table) else 0.0

    def _near_ground(self, flights: list[Span]) -> list[Span]:
        """When it was near the height at which it took off; all of it when the log has no heights."""
        if not self.has("XKF1"):
            return []
        table = self.estimate()
        time, height = table.time, -table["PD"]
        low: list[Span] = []
        for flight in flights:
            k = int(np.clip(np.searchsorted(time, flight.begin), 0, len(time) - 1))
            inside = (time >= flight.begin) & (time <= flight.end)
            near = inside & (height < height[k] + self._above)
            low += _spans_of(time, near)
        return low

    def _failsafes(self) -> list[Span]:
        if not self.has("ERR"):
            return []
        table, spans = self.columns["ERR"], []
        begun: dict[int, float] = {}
        for time, which, code in zip(table.time, table["Subsys"].astype(int), table["ECode"].astype(int)):
            if which not in _FAILSAFES:
                continue
            if code:
                begun.setdefault(which, float(time))
            elif which in begun:
                spans.append(Span(begun.pop(which), float(time) + _SETTLES_S))
        return spans + [Span(time, np.inf) for time in begun.values()]

    def inside(self, time: Array) -> Array:
        """Which times are within ``spans``."""
        return within(time, self.spans)

    @property
    def at_rest(self) -> list[Span]:
        """When it stood disarmed, with motors off, as far as the log has it (LOG_DISARMED)."""
        begin = float(self.columns["IMU"].time[0]) if self.has("IMU") else 0.0
        ends = [begin - _SETTLES_S, *(span.end for span in self.armed)]
        starts = [*(span.begin for span in self.armed), self._end + _SETTLES_S]
        spans = [Span(a + _SETTLES_S, b - _SETTLES_S) for a, b in zip(ends, starts)]
        return [span for span in spans if span.length > 2.0 * _SETTLES_S]

    @property
    def altitude(self) -> float:
        """Median over the flight above sea level [m]; 0 when no receiver says it."""
        if not self.has("GPS"):
            return 0.0
        table = self.stream("GPS", 0)
        heights = table["Alt"][(table["Status"] >= 3) & self.inside(table.time)]
        return float(np.median(heights)) if len(heights) else 0.0

    @property
    def conditions(self) -> Conditions:
        """Voltage, lift and altitude in the air."""
        voltage, lift = np.nan, 1.0
        if self.has("BAT"):
            battery = self.stream("BAT", 0)
            volts = battery["Volt"][self.inside(battery.time)]
            voltage = float(volts.mean()) if len(volts) and volts.min() > 0.0 else np.nan
        if self.has("MOTB"):
            motors = self.stream("MOTB")
            lifts = motors["LiftMax"][self.inside(motors.time)]
            lift = float(lifts.mean()) if len(lifts) and lifts.min() > 0.0 else 1.0
        return Conditions(voltage, lift, self.altitude)


def _spans_of(time: Array, inside: Array) -> list[Span]:
    """Stretches where a mask is true."""
    steps = np.flatnonzero(np.diff(np.concatenate([[0], inside.astype(int), [0]])))
    return [Span(float(time[a]), float(time[b - 1])) for a, b in zip(steps[::2], steps[1::2])]


def _without(spans: list[Span], others: list[Span]) -> list[Span]:
    """What is left of spans."""
    for other in others:
        left: list[Span] = []
        for span in spans:
            if other.end <= span.begin or other.begin >= span.end:
                left.append(span)
                continue
            left += [Span(span.begin, other.begin)] * (other.begin > span.begin)
            left += [Span(other.end, span.end)] * (other.end < span.end)
        spans = left
    return spans
