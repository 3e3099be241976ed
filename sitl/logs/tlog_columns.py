# SPDX-License-Identifier: BSD-3-Clause
"""A telemetry log (.tlog) as columns, under the names that ArduPilot has for them in DataFlash logs.

What an ArduPilot vehicle sends says less than its own log, more coarsely and less often: ``SOURCES`` tells which
MAVLink message a table comes from. Messages: https://mavlink.io/en/messages/ardupilotmega.html. Parameters are those of
PARAM_VALUE, or of the file that ground stations get by FTP.
"""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import numpy as np
from pymavlink.dialects.v20 import ardupilotmega as dialect

from ..autopilot.log_events import LogErrorSubsystem, LogEvent
from ..core.constants import GRAVITY
from ..core.mavlink import MavAutopilot, MavLandedState, MavModeFlag, MavState
from .dataflash.tables import Array, Table, Tables
from .kind import kind_of_mav_type, logs_of
from .telemetry_frames import Rows, read
from .telemetry_parameters import by_ftp
from .tlog import LogError

_DEG = 180.0 / np.pi
_XYZ = (("X", "x"), ("Y", "y"), ("Z", "z"))
_FIELDS: dict[str, tuple[str, dict[str, tuple[str, float]]]] = {
    "ATT": ("ATTITUDE", {name: (name.lower(), _DEG) for name in ("Roll", "Pitch", "Yaw")}),
    "XKF1": (
        "LOCAL_POSITION_NED",
        {k: (v, 1.0) for k, v in zip(("PN", "PE", "PD", "VN", "VE", "VD"), ("x", "y", "z", "vx", "vy", "vz"))},
    ),
    "IMU": (
        "RAW_IMU",
        {f"Acc{a}": (f"{b}acc", 1e-3 * GRAVITY) for a, b in _XYZ} | {f"Gyr{a}": (f"{b}gyro", 1e-3) for a, b in _XYZ},
    ),
    "MAG": ("RAW_IMU", {f"Mag{a}": (f"{b}mag", 1.0) for a, b in _XYZ}),
    "RCOU": ("SERVO_OUTPUT_RAW", {f"C{k}": (f"servo{k}_raw", 1.0) for k in range(1, 17)}),
    "BAT": ("BATTERY_STATUS", {"Curr": ("current_battery", 0.01), "CurrTot": ("current_consumed", 1.0)}),
    "VIBE": ("VIBRATION", {f"Vibe{a}": (f"vibration_{b}", 1.0) for a, b in _XYZ}),
    "BARO": ("SCALED_PRESSURE", {"Press": ("press_abs", 100.0)}),
    "GPS": (
        "GPS_RAW_INT",
        {"Status": ("fix_type", 1.0), "Lat": ("lat", 1e-7), "Lng": ("lon", 1e-7), "Alt": ("alt", 1e-3)},
    ),
}
SOURCES = {name: message for name, (message, _) in _FIELDS.items()}
"""Table -> MAVLink message."""
_OTHERS = (
    "AUTOPILOT_VERSION",
    "EXTENDED_SYS_STATE",
    "FILE_TRANSFER_PROTOCOL",
    "HEARTBEAT",
    "PARAM_VALUE",
    "STATUSTEXT",
)
_WANTED = frozenset((*SOURCES.values(), *_OTHERS))
_UNKNOWN_MV = 65535
_REBOOT_S = 1.0


class Telemetry(Tables):
    """What the first ArduPilot vehicle in a .tlog sent. Times are since its boot.

    Args:
        path: of the .tlog.
        progress: called with how many bytes are read, and how many there are.

    Raises:
        LogError: it cannot be read, or is of no ArduPilot vehicle that the simulator has.
    """

    def __init__(self, path: str | Path, progress: Callable[[int, int], None] | None = None) -> None:
        super().__init__(path)
        try:
            frames, bad = read(self.path, _WANTED, progress)
        except OSError as error:
            raise LogError(f"log {str(path)!r} cannot be read: {error.strerror or error}") from None
        self.bad = bad
        """Frames whose checksum is wrong."""
        system, self._kind = self._vehicle(frames)
        self._boots = np.zeros((0, 3))
        """Logged time [s], time since boot [s], time since the first boot [s] of all messages that have both."""
        raw = {name: rows for (number, name), rows in frames.items() if number == system}
        self._learn_boots(raw)
        for name, (message, fields) in _FIELDS.items():
            if message in raw:
                self._add(name, *self._columns(name, raw[message], fields))
        self._states(raw)
        self._parameters(raw)
        self._texts(raw)
        self._drop_odd_times()

    @property
    def kind(self) -> str:
        return self._kind

    # ------------------------------------------------------------------ frames

    def _vehicle(self, frames: dict[tuple[int, str], Rows]) -> tuple[int, str]:
        """System and kind of the first vehicle of ArduPilot."""
        others = []
        for (system, name), rows in sorted(frames.items()):
            if name != "HEARTBEAT":
                continue
            for autopilot, kind in dict.fromkeys(zip(rows["autopilot"].tolist(), rows["type"].tolist())):
                found = kind_of_mav_type(int(kind))
                if autopilot == MavAutopilot.ARDUPILOTMEGA and found is not None:
                    return system, found
                if autopilot != MavAutopilot.INVALID:
                    words = _word("MAV_TYPE", kind), _word("MAV_AUTOPILOT", autopilot)
                    others.append(f"system {system} is a {words[0]} with autopilot {words[1]}")
        what = "; ".join(others) or "it has no HEARTBEAT of an autopilot"
        raise LogError(f"log {str(self.path)!r} is of no copter or rover of ArduPilot: {what}")

    def _learn_boots(self, raw: dict[str, Rows]) -> None:
        parts = [
            np.column_stack([rows.logged, 1e-3 * rows["time_boot_ms"]])
            for rows in raw.values()
            if "time_boot_ms" in rows
        ]
        if not parts:
            return
        logged, boot = np.concatenate(parts)[np.argsort(np.concatenate(parts)[:, 0], kind="stable")].T
        starts = np.diff(boot, prepend=boot[:1]) < -_REBOOT_S  # time goes on
        passed = np.diff(logged, prepend=logged[:1]) - np.diff(boot, prepend=boot[:1])
        self._boots = np.column_stack([logged, boot, boot + np.cumsum(np.where(starts, passed, 0.0))])

    def _times(self, rows: Rows) -> Array:
        """Since the first boot [s]: the message's own, or between those of its neighbours in the log."""
        if not len(self._boots):
            return rows.logged
        logged, boot, whole = self._boots.T
        if "time_boot_ms" in rows:
            k = np.searchsorted(logged, rows.logged, "right") - 1
            return 1e-3 * rows["time_boot_ms"] + (whole - boot)[k]
        inside = np.interp(rows.logged, logged, whole)
        return inside + np.minimum(rows.logged - logged[0], 0.0) + np.maximum(rows.logged - logged[-1], 0.0)

    # ------------------------------------------------------------------ tables

    def _columns(self, name: str, rows: Rows, fields: dict[str, tuple[str, float]]) -> tuple[Array, dict[str, Array]]:
        columns = {label: scale * rows[field] for label, (field, scale) in fields.items()}
        keep = np.ones(len(rows), bool)
        if name == "RCOU":
            keep = rows["port"] == 0
        elif name == "BAT":
            cells = rows["voltages"]
            columns["Volt"] = 1e-3 * np.where(cells < _UNKNOWN_MV, cells, 0.0).sum(1)
            keep = (rows["id"] == 0) & (rows["current_battery"] >= 0)
        elif name == "GPS":  # one fix is sent again and again
            keep = np.diff(rows["time_usec"], prepend=-1.0) != 0.0
            columns["VZ"] = np.full(len(rows), np.nan)
        return self._times(rows)[keep], {label: column[keep] for label, column in columns.items()}

    def _add(self, name: str, time: Array, columns: dict[str, Array]) -> None:
        kinds = {label: "Z" if column.dtype.kind == "U" else "d" for label, column in columns.items()}
        raw = np.zeros(len(time), [("TimeUS", "i8"), *((label, column.dtype) for label, column in columns.items())])
        raw["TimeUS"] = np.round(1e6 * time)
        for label, column in columns.items():
            raw[label] = column
        self._tables[name] = Table(name, raw, {"TimeUS": "Q", **kinds}, {})

    def _states(self, raw: dict[str, Rows]) -> None:
        """ARM, ERR of HEARTBEAT; EV of EXTENDED_SYS_STATE: when they changed."""
        rows = raw["HEARTBEAT"]
        rows = rows.where(rows["autopilot"] == MavAutopilot.ARDUPILOTMEGA)
        time, armed = self._times(rows), (rows["base_mode"].astype(int) & MavModeFlag.SAFETY_ARMED) > 0
        fails = armed & (rows["system_status"] == MavState.CRITICAL)
        for name, label, values, first in (("ARM", "ArmState", armed, True), ("ERR", "ECode", fails, False)):
            changed = np.diff(values.astype(int), prepend=-1 if first else 0) != 0
            columns = {label: values[changed].astype(float)}
            if name == "ERR":
                columns["Subsys"] = np.full(int(changed.sum()), float(LogErrorSubsystem.FAILSAFE_RADIO))
            self._add(name, time[changed], columns)
        if (landed := raw.get("EXTENDED_SYS_STATE")) is not None:
            landed = landed.where(landed["landed_state"] != MavLandedState.UNDEFINED)
            flies = landed["landed_state"] != MavLandedState.ON_GROUND
            changed = np.diff(flies.astype(int), prepend=0) != 0
            identifiers = np.where(flies[changed], float(LogEvent.NOT_LANDED), float(LogEvent.LAND_COMPLETE))
            self._add("EV", self._times(landed)[changed], {"Id": identifiers})

    def _parameters(self, raw: dict[str, Rows]) -> None:
        found = by_ftp(raw["FILE_TRANSFER_PROTOCOL"]["payload"]) if "FILE_TRANSFER_PROTOCOL" in raw else {}
        if (rows := raw.get("PARAM_VALUE")) is not None:
            found |= dict(zip(rows.texts("param_id"), rows["param_value"].tolist()))
        if found:
            names, values = np.array(list(found), "U16"), np.array(list(found.values()), float)
            self._add("PARM", np.full(len(found), self._first()), {"Name": names, "Value": values})

    def _texts(self, raw: dict[str, Rows]) -> None:
        """MSG, with the firmware's name by AUTOPILOT_VERSION where no text says it."""
        time, texts = np.zeros(0), np.zeros(0, "U64")
        if (rows := raw.get("STATUSTEXT")) is not None:
            time, texts = self._times(rows), np.array(rows.texts("text"), "U64")
        if (versions := raw.get("AUTOPILOT_VERSION")) is not None:
            number = int(versions["flight_sw_version"][-1])
            name = f"{logs_of(self._kind).title} V{number >> 24}.{number >> 16 & 255}.{number >> 8 & 255}"
            time, texts = np.append(time, self._first()), np.append(texts, name)
        if len(texts):
            self._add("MSG", time, {"Message": texts})

    def _first(self) -> float:
        return min((float(table.time[0]) for table in self._tables.values() if len(table)), default=0.0)


def _word(enum: str, number: int) -> str:
    entry = dialect.enums[enum].get(int(number))
    return entry.name.removeprefix(f"{enum}_") if entry is not None else f"{enum} {number:.0f}"
