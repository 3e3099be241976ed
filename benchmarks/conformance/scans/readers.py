# SPDX-License-Identifier: BSD-3-Clause
"""On-board logs of the same flight as four readers give them: numbers at rest in GUIDED, and units if it has some.

A row is "READER MESSAGE.FIELD" or "READER unit MESSAGE.FIELD". Only readers that are installed have rows:
``pip install pymavlog ardupilot-log-reader mavpose`` ("pymavlog" wants numpy 1).
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from fnmatch import fnmatchcase
from importlib.util import find_spec
from pathlib import Path
from statistics import median
from tempfile import TemporaryDirectory
from typing import Any

import numpy as np

from .fields import agrees
from .logs import flown, last
from .program import Programs

__all__ = ["READERS", "agrees", "scan"]
NUMBERS: Mapping[str, Mapping[str, float]] = {
    "ATT": {"Roll": 0.6, "Pitch": 0.6, "Yaw": 4.0},
    "BAT": {"Volt": 0.2, "Curr": 3.0, "CurrTot": 60.0, "RemPct": 3.0},
    "GPS": {"Status": 0.0, "NSats": 1.0, "HDop": 0.1, "Lat": 1e-5, "Lng": 1e-5, "Alt": 1.0, "Spd": 0.3},
    "IMU": {"AccX": 0.5, "AccZ": 0.5, "GyrX": 0.06},
    "BARO": {"Alt": 1.0, "Press": 150.0},
    "MAG": {"MagX": 40.0, "MagY": 40.0, "MagZ": 40.0, "OfsX": 1.0},
    "POS": {"Lat": 1e-5, "Lng": 1e-5, "Alt": 1.0, "RelHomeAlt": 1.0},
    "RCIN": {"C1": 0.0, "C3": 0.0},
    "SIM": {"Roll": 0.6, "Yaw": 4.0, "Alt": 1.0, "Lat": 1e-5, "Lng": 1e-5},
    "SIM2": {"PN": 1.0, "PE": 1.0, "PD": 1.0, "VN": 0.1},
    "XKF1": {"Roll": 0.6, "Yaw": 4.0, "PN": 1.0, "PE": 1.0, "PD": 1.0},
    "XKF4": {"SV": 0.05, "SP": 0.05, "SH": 0.05, "SM": 0.05, "errRP": 0.01, "PI": 0.0},
}
"""What is read, and how far it may be from the real one's."""
INSTANCES = ("I", "Inst", "C")
"""Fields that tell the sensor or filter; the first one's rows count."""
Columns = Callable[[str], Mapping[str, Any]]


def _pymavlink(path: Path) -> Columns:
    from pymavlink import DFReader

    log, found = DFReader.DFReader_binary(str(path)), dict[str, dict[str, list[Any]]]()
    while (m := log.recv_match(type=list(NUMBERS))) is not None:
        columns = found.setdefault(m.get_type(), {name: [] for name in m.fmt.columns})
        for name in columns:
            columns[name].append(getattr(m, name))
    log.close()
    return found.__getitem__


def _pymavlog(path: Path) -> Columns:
    from pymavlog import MavLog

    log = MavLog(str(path))
    log.parse()

    def columns(message: str) -> Mapping[str, Any]:
        return {name: log[message][name] for name in log[message].columns}

    return columns


def _ardupilot_log_reader(path: Path) -> Columns:
    from ardupilot_log_reader.reader import Ardupilot

    return dict(Ardupilot.parse(str(path), types=list(NUMBERS), zero_time_base=False).dfs).__getitem__


class Frames:
    """Frames of a log that mavpose has read, and their units."""

    def __init__(self, log: Any) -> None:
        self._log = log

    def __call__(self, message: str) -> Mapping[str, Any]:
        return dict(self._log.frame(message))

    def unit(self, message: str, field: str) -> str | None:
        """Of a field."""
        return self._log.unit(message, field)


def _mavpose(path: Path) -> Columns:
    import mavpose

    return Frames(mavpose.load(str(path)))


READERS: Mapping[str, Callable[[Path], Columns]] = {
    "pymavlink": _pymavlink,
    "pymavlog": _pymavlog,
    "ardupilot_log_reader": _ardupilot_log_reader,
    "mavpose": _mavpose,
}
"""By the name of the package that is imported."""


def scan(programs: Programs) -> dict[str, Any]:
    """All rows of the readers that are installed and wanted."""
    rows: dict[str, Any] = {}
    with TemporaryDirectory(prefix="readers-") as folder:
        begin, end = flown(programs, Path(folder))
        path = last(folder)
        assert path is not None, "a flight is logged"
        for reader, read in READERS.items():
            names = [name for name in _names(reader) if fnmatchcase(name, programs.rows)]
            if names and find_spec(reader) is not None:
                rows |= _of(reader, read(path), begin, end)
    return {name: value for name, value in rows.items() if fnmatchcase(name, programs.rows)}


def _names(reader: str) -> list[str]:
    return [f"{reader} {message}.{field}" for message, fields in NUMBERS.items() for field in fields]


def _of(reader: str, columns: Columns, begin: float, end: float) -> dict[str, Any]:
    rows: dict[str, Any] = {}
    for message, fields in NUMBERS.items():
        found = columns(message)
        times = np.asarray(found["TimeUS"], float) * 1e-6
        chosen = (times >= begin) & (times <= end)
        for name in INSTANCES:
            if name in found:
                chosen &= np.asarray(found[name]) == 0
        for field, tolerance in fields.items():
            x = median(np.asarray(found[field], float)[chosen].tolist())
            rows[f"{reader} {message}.{field}"] = [float(f"{x:.9g}"), tolerance]
            if isinstance(columns, Frames):
                rows[f"{reader} unit {message}.{field}"] = columns.unit(message, field)
    return rows
