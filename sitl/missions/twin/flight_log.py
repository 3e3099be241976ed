# SPDX-License-Identifier: BSD-3-Clause
"""One flight of a DataFlash log: when it was armed, where it began, and its messages by the time since arming."""

from __future__ import annotations

import math
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np

from sitl.core import elementary_arrays as arrays
from sitl.errors import OptionError, SitlError
from sitl.logs import forms
from sitl.logs.dataflash.columns import Columns, Table
from sitl.logs.dataflash.tables import ESTIMATES
from sitl.scenario import Home

Array = np.ndarray[Any, Any]

_ARMED, _DISARMED = 10, 11
"""EV.Id"""
_NAMES = (
    "AHR2", "ARM", "ATT", "BAT", "CMD", "CTUN", "CURR", "DSF", "EKF1", "EV", "GPS", "GUIA", "GUIP", "IMU", "MAVC",
    "MODE", "MSG", "NKF1", "NKF2", "NKF4", "PARM", "POS", "PSCD", "PSCE", "PSCN", "RATE", "RCIN", "RCOU", "SIM2",
    "STER", "THR", "XKF1", "XKF2", "XKF4",
)  # fmt: skip
"""Messages that are read."""
_LEAST_S = 3.0
"""A shorter time armed is no flight."""
_LEAST_MOTION_M = 1.0
"""A vehicle that never came farther from where it was armed did not leave the ground, or did not drive."""


class TwinError(SitlError, ValueError):
    """A log whose flight cannot be flown again; the message names it and says why."""


class Span(NamedTuple):
    """From arming to disarming, by the log's clock [s]."""

    armed: float
    disarmed: float
    is_whole: bool
    """Whether the log shows the disarming; else it ends before."""

    @property
    def length(self) -> float:
        """[s]"""
        return self.disarmed - self.armed


class FlightLog:
    """A log, and one of its flights.

    Args:
        path: of a .bin, or a .log as text.
        number: of the flight, from 1; None: the one that was armed longest.
        must_move: whether a vehicle that did not leave the ground, or did not drive, is refused.

    Raises:
        sitl.logs.tlog.LogError: it cannot be read, or is of a vehicle that the simulator does not have.
        TwinError: it holds no flight.
        OptionError: it has no flight of this number.
    """

    def __init__(self, path: str | Path, number: int | None = None, must_move: bool = True) -> None:
        self.path = Path(path)
        form = forms.of(self.path)
        if form != forms.DATAFLASH:
            raise TwinError(
                f"log {str(path)!r} is {form}; a twin is made of the on-board log (DataFlash: .bin, .log), which the "
                "vehicle keeps on its card and ground stations download"
            )
        self.columns = Columns(self.path, _NAMES)
        self.columns.alias_battery()
        self.kind = self.columns.kind
        if self.columns.helicopter:
            raise TwinError(f"log {str(path)!r} is of a helicopter ({self.columns.helicopter}), which is not simulated")
        if "PARM" not in self.columns:
            raise TwinError(
                f"log {str(path)!r} has no PARM: without its parameters the flight cannot be flown again; "
                "it begins in the middle, or its start is damaged"
            )
        self.flights = self._flights()
        """All of the log."""
        if not self.flights:
            raise TwinError(
                f"log {str(path)!r}: the vehicle was never armed for {_LEAST_S:g} s (ARM, EV): there is no flight"
            )
        if number is not None and not 1 <= number <= len(self.flights):
            raise OptionError(f"flight {number}: log {str(path)!r} has flights 1 to {len(self.flights)}")
        self.number = number or 1 + max(range(len(self.flights)), key=lambda k: self.flights[k].length)
        self.span = self.flights[self.number - 1]
        self.stands = self._standing()
        """Why this is no flight: the vehicle did not move; "": it did."""
        if self.stands and must_move:
            raise TwinError(self.stands)

    @property
    def name(self) -> str:
        """Of the file."""
        return self.path.name

    @property
    def version(self) -> tuple[int, int]:
        """Of its firmware; (4, 7) when the log does not say it."""
        return self.columns.version or (4, 7)

    def has(self, name: str, *fields: str) -> bool:
        """Whether it has messages of a name with these fields."""
        return name in self.columns and all(field in self.columns[name] for field in fields)

    def table(self, name: str, instance: int | None = None) -> Table:
        """Messages of a name, or of one sensor of these, in the order of their times."""
        table = self.columns[name]
        if instance is not None:
            table = table.where(table["Inst"] == instance) if "Inst" in table else table.instance(instance)
        return _rising(table)

    def every(self, name: str) -> Table | None:
        """All messages of a name, of one time, too; None: it has none."""
        return self.columns[name] if name in self.columns else None  # noqa: SIM401 it is no dictionary

    def since_arming(self, table: Table) -> Array:
        """Times of messages since the arming [s]."""
        return table.time - self.span.armed

    def estimate(self) -> Table:
        """Position and velocity of the filter's lane that was flown by.

        Raises:
            TwinError: the log has none; SIM2 is in logs of a vehicle that flies by its true state.
        """
        name = self.columns.estimate or "SIM2"
        if self.has(name, "PN", "PE", "PD", "VN", "VE", "VD"):
            return _rising(self.columns.lane(name))
        raise TwinError(
            f"log {str(self.path)!r} has none of {', '.join(ESTIMATES)}, SIM2: positions and velocities are not known "
            "(LOG_BITMASK was without attitude)"
        )

    def at_arming(self, time: Array, values: Array) -> float:
        """What a stream was when the vehicle was armed: the last value before, or the first one after."""
        k = int(np.searchsorted(time, 1e-3, "right")) - 1
        return float(values[max(k, 0)])

    def home(self) -> Home:
        """Where the vehicle stood when it was armed, and its heading.

        Raises:
            TwinError: the log does not say it.
        """
        for name in ("POS", "AHR2", "GPS"):
            if self.has(name, "Lat", "Lng", "Alt"):
                table = self.table(name, 0 if name == "GPS" else None)
                time = self.since_arming(table)
                location = tuple(self.at_arming(time, table[field]) for field in ("Lat", "Lng", "Alt"))
                if all(map(math.isfinite, location)) and (location[0] or location[1]):
                    return (location[0], location[1], location[2], self._heading())
        raise TwinError(f"log {str(self.path)!r} tells no position (POS, AHR2, GPS): a twin needs one to begin at")

    def _heading(self) -> float:
        """At arming [deg]; 0: the log does not say it."""
        if not self.has("ATT", "Yaw"):
            return 0.0
        attitude = self.table("ATT")
        return self.at_arming(self.since_arming(attitude), attitude["Yaw"]) % 360.0

    # ------------------------------------------------------------------

    def _changes(self) -> list[tuple[float, bool]]:
        arm, event = self.every("ARM"), self.every("EV")
        if arm is not None and "ArmState" in arm:
            return [(float(t), bool(state)) for t, state in zip(arm.time, arm["ArmState"])]
        if event is not None and "Id" in event:
            found = zip(event.time.tolist(), event["Id"].astype(int).tolist())
            return [(t, number == _ARMED) for t, number in found if number in (_ARMED, _DISARMED)]
        return []

    def _flights(self) -> list[Span]:
        times = [self.columns[name].time for name in self.columns]
        end = max((float(time[-1]) for time in times if len(time)), default=0.0)
        spans: list[Span] = []
        since: float | None = None
        changes = self._changes()
        if changes and not changes[0][1] and self.columns.parameters.get("LOG_DISARMED", 0.0) == 0.0:
            since = self.columns.began  # the arming opened the log, which misses it
        for time, state in changes:
            if state and since is None:
                since = time
            elif not state and since is not None:
                spans.append(Span(since, time, True))
                since = None
        if since is not None:
            spans.append(Span(since, end, False))
        return [span for span in spans if span.length >= _LEAST_S]

    def _standing(self) -> str:
        table = self.estimate()
        time = self.since_arming(table)
        inside = (time >= 0.0) & (time <= self.span.length)
        if inside.sum() < 2:
            raise TwinError(f"log {str(self.path)!r}: flight {self.number} has no positions: the log is damaged there")
        if self.kind == "copter":
            height = -table["PD"][inside]
            distance, what = float(height.max() - height[0]), "left the ground"
        else:
            north, east = table["PN"][inside], table["PE"][inside]
            distance, what = float(arrays.hypot(north - north[0], east - east[0]).max()), "drove"
        if distance >= _LEAST_MOTION_M:
            return ""
        return (
            f"log {str(self.path)!r}: in flight {self.number} of {len(self.flights)} "
            f"({self.span.length:.0f} s armed) the vehicle never {what}"
        )


def _rising(table: Table) -> Table:
    """Messages in the order of their times."""
    time = table.time
    later = np.ones(len(time), bool)
    later[1:] = time[1:] > np.maximum.accumulate(time)[:-1]
    return table.where(later)
