# SPDX-License-Identifier: BSD-3-Clause
"""Messages of a log as NumPy columns, by the names that ArduPilot has for them in DataFlash logs."""

from __future__ import annotations

import re
from collections import Counter
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import numpy as np

from .. import firmwares
from ..tlog import LogError
from .formats import READ_DIVISORS, clock

Array = np.ndarray[Any, Any]

_VERSION = re.compile(r"V(\d+)\.(\d+)")
_HELICOPTERS = (6, 11, 13)
"""FRAME_CLASS: Heli, Heli_Dual, HeliQuad."""
ESTIMATES = {"XKF1": 3, "NKF1": 2, "EKF1": 2}
"""Messages with position and velocity -> the filter of AHRS_EKF_TYPE and ATT.AEKF."""
FAR_S = 600.0
"""A log that is kept only while armed pauses between flights; times that are farther from all others than this are odd,
unless many messages have them [s]."""
_MANY = 10
"""Messages that are not odd together."""
_INSTANCES = ("I", "C", "IMU", "Instance", "Id")


class Table:
    """The messages of one name.

    Args:
        name: of the message.
        raw: as they are in the file, a structured array.
        letters: field -> letter of its type.
        units: field -> unit, as far as the log has it.
        times: of messages without a time of their own: that of the message before each [s].
    """

    def __init__(
        self,
        name: str,
        raw: Array,
        letters: dict[str, str],
        units: dict[str, str],
        times: Array | None = None,
    ) -> None:
        self.name, self.raw, self.letters, self.units = name, raw, letters, units
        self._times = times

    def __len__(self) -> int:
        return len(self.raw)

    def __contains__(self, field: object) -> bool:
        return field in self.letters

    @property
    def fields(self) -> tuple[str, ...]:
        """Names of its fields."""
        return tuple(self.letters)

    def __getitem__(self, field: str) -> Array:
        """A column: numbers as float64, degrees for latitudes and longitudes; texts as ``str``.

        Raises:
            LogError: the messages have no such field.
        """
        if field not in self.letters:
            raise LogError(f"{self.name} of this log has no field {field!r}; it has {', '.join(self.letters)}")
        column, letter = self.raw[field], self.letters[field]
        if column.dtype.kind == "S":
            return np.char.decode(column, "utf-8", "replace")
        if column.dtype.kind == "U":
            return column
        values = column.astype(np.float64)
        is_stored = column.dtype.kind in "iu"  # a log as text has what is meant
        return values / READ_DIVISORS[letter] if is_stored and letter in READ_DIVISORS else values

    @property
    def time(self) -> Array:
        """Since the autopilot's boot [s]: their own, or that of the message before each (ArduPilot 3.2 and before has
        EV, MODE and others without); empty when that is not known."""
        if self._times is not None:
            return self._times
        found = clock(self.letters)
        return np.zeros(0) if found is None else self.raw[found[0]].astype(np.float64) * found[1]

    def instance(self, number: int = 0) -> Table:
        """The messages of one sensor, filter ...; all of them when they have no number."""
        label = next((label for label in _INSTANCES if label in self.letters), None)
        if label is None or not len(self):
            return self
        return self.where(self.raw[label] == number)

    def where(self, which: Array) -> Table:
        """Those messages that a mask, a slice or numbers say."""
        times = None if self._times is None else self._times[which]
        return Table(self.name, self.raw[which], self.letters, self.units, times)

    @property
    def rate(self) -> float:
        """Messages a second: the median over the log [Hz]; 0 with less than two."""
        steps = np.diff(self.time)
        steps = steps[steps > 0.0]
        return float(1.0 / np.median(steps)) if len(steps) else 0.0


class Tables:
    """A log: its messages, and what they say of it.

    Args:
        path: of the file.
    """

    _tables: dict[str, Table]

    def __init__(self, path: str | Path) -> None:
        self.path = Path(path)
        self.left_out = 0
        """Messages whose time cannot be."""
        self.formats: set[str] = set()
        """Names of messages that it has a format of."""
        self._tables = {}

    def __contains__(self, name: object) -> bool:
        return name in self._tables and len(self._tables[str(name)]) > 0

    def __iter__(self) -> Iterator[str]:
        return (name for name, table in self._tables.items() if len(table))

    def __getitem__(self, name: str) -> Table:
        """The messages of a name.

        Raises:
            LogError: the log has none; the message lists those there are.
        """
        if name not in self:
            raise LogError(f"log {str(self.path)!r} has no {name}; it has {', '.join(sorted(self)) or 'nothing'}")
        return self._tables[name]

    def alias(self, name: str, other: str) -> None:
        """Give messages ``other`` the name ``name`` as well, when the log has none of that name."""
        if other in self and name not in self:
            self._tables[name] = self._tables[other]

    def alias_battery(self) -> None:
        """CURR of ArduPilot 3.4 and 3.5 is BAT as well; before, it is in hundredths of volts and amperes."""
        if "CURR" in self and self["CURR"].letters.get("Volt") == "f":
            self.alias("BAT", "CURR")

    @property
    def began(self) -> float:
        """Time of the first message [s]; 0 when none has one."""
        return min((float(table.time[0]) for table in self._tables.values() if len(table.time)), default=0.0)

    # ------------------------------------------------------------------ what it is of

    @property
    def parameters(self) -> dict[str, float]:
        """The last value of each."""
        if "PARM" not in self:
            return {}
        table = self["PARM"]
        return dict(zip(table["Name"].tolist(), table["Value"].tolist()))

    @property
    def texts(self) -> list[tuple[float, str]]:
        """(Time [s], text) of all MSG; one that was cut into pieces is in pieces."""
        if "MSG" not in self:
            return []
        table = self["MSG"]
        times = table.time if len(table.time) else np.zeros(len(table))
        return list(zip(times.tolist(), table["Message"].tolist()))

    @property
    def firmware(self) -> str:
        """As it names itself: "ArduCopter V4.6.3 (3fc7011a)"; "" when the log does not say it."""
        named = next((text for _, text in self.texts if any(firmwares.of_text(text))), "")
        if named or "VER" not in self or "FWS" not in self["VER"]:
            return named
        return str(self["VER"]["FWS"][0])

    @property
    def version(self) -> tuple[int, int] | None:
        """Of the firmware: (4, 6); None when the log does not say it."""
        found = _VERSION.search(self.firmware)
        return (int(found[1]), int(found[2])) if found else None

    @property
    def estimate(self) -> str:
        """Message with position and velocity of the filter that was flown by ("XKF1", "NKF1"), by ATT.AEKF or
        AHRS_EKF_TYPE; else the one that it has most of; "": none."""
        there = [name for name in ESTIMATES if name in self]
        flown = int(self.parameters.get("AHRS_EKF_TYPE", 0))
        if "ATT" in self and "AEKF" in self["ATT"]:
            flown, _ = Counter(self["ATT"]["AEKF"].astype(int).tolist()).most_common(1)[0]
        most = max(there, key=lambda name: len(self[name]), default="")
        return next((name for name in there if ESTIMATES[name] == flown), most)

    def lane(self, name: str) -> Table:
        """The messages of a filter's lane that was flown by at each time; all of them when they have no number.

        Args:
            name: ``estimate``.
        """
        table, primary = self[name], f"{name[:-1]}4"
        if "C" not in table:
            return table
        lanes = np.zeros(len(table))
        if primary in self and "PI" in self[primary]:
            before = np.searchsorted(self[primary].time, table.time, "right") - 1
            lanes = np.where(before >= 0, self[primary]["PI"][np.maximum(before, 0)], 0.0)
        return table.where(table["C"] == lanes)

    @property
    def helicopter(self) -> str:
        """What says that it is a helicopter, whose rotors have pitch ("FRAME_CLASS 6"): ArduPilot counts it among the
        copters; "": nothing."""
        number = int(self.parameters.get("FRAME_CLASS", 0))
        if number in _HELICOPTERS:
            return f"FRAME_CLASS {number}"
        named = re.match(r"\S*heli\w* V\d", self.firmware, re.IGNORECASE)
        return self.firmware if named else ""

    @property
    def kind(self) -> str:
        """Kind of vehicle.

        Raises:
            LogError: the log does not say it, or it is one that the simulator does not have.
        """
        kind, other = next((one for one in self._kinds() if any(one)), ("", ""))
        if other:
            raise LogError(f"log {str(self.path)!r} is of {other}; logs of copters and rovers are taken")
        if not kind:
            raise LogError(
                f"log {str(self.path)!r} does not say what vehicle it is of: it has no MSG, VER or PARM of it"
            )
        return kind

    def _kinds(self) -> Iterator[tuple[str, str]]:
        """Kind of vehicle, or what it is else, by all that tells it, the surest first."""
        yield from (firmwares.of_text(text) for _, text in self.texts)
        if "VER" in self and "BU" in self["VER"]:
            yield firmwares.of_build(int(self["VER"]["BU"][0]))
        yield from map(firmwares.of_parameter, self.parameters)

    def _drop_odd_times(self) -> None:
        """Leave out messages whose time cannot be: few, and far from the times of all others."""
        timed = [table for table in self._tables.values() if len(table.time)]
        if not timed:
            return
        times = np.sort(np.concatenate([table.time for table in timed]), kind="stable")
        begins = np.concatenate([[0], np.flatnonzero(np.diff(times) > FAR_S) + 1, [len(times)]])
        counts = np.diff(begins)
        good = counts >= min(_MANY, counts.max())
        if good.all():
            return
        starts = times[begins[:-1]]
        for table in timed:
            fits = good[np.searchsorted(starts, table.time, "right") - 1]
            if not fits.all():
                self.left_out += int((~fits).sum())
                self._tables[table.name] = table.where(fits)
