# SPDX-License-Identifier: BSD-3-Clause
"""Which of a log's parameters its twin takes over: those that say how it is flown, not what it is made of."""

from __future__ import annotations

import math
import re
from dataclasses import dataclass, field

from sitl.autopilot.params.parm_files import FileValues
from sitl.autopilot.params.renamed import here
from sitl.autopilot.params.table import Table

from .flight_log import FlightLog

_OWN = re.compile(
    r"AHRS_(TRIM|ORIENT|EKF|GPS_USE)|ARMING_|ARSPD|BARO|BATT\d?_(MONITOR|VOLT_|CURR_|AMP_|I2C|SERIAL|OPTIONS|ESC|SHUNT)"
    r"|BCN_|BRD_|CAN_|CAM|COMPASS_|DEV_|EAHRS_|EK[23]_(ENABLE|SRC|IMU|PRIMARY|GPS|MAG|AFFINITY|DRAG)|ESC_|FFT_"
    r"|FLOW|FORMAT_|FRAME_|FS_GCS_ENABL|GPS|INITIAL_MODE|INS_(ACC\d?_|ACC\d?OFFS|ACC\d?SCAL|ACC_?\d?_?ID|ACCOFFS|ACCSCAL"
    r"|GYR|USE|ENABLE|POS|TCAL|FAST|RAW|LOG|TRIM|STILL|BODYFIX)|LOG_|MOT_PWM_M|MAV\d*_|MIS_TOTAL|MNT|NET_|NTF_|OSD|PLND_|PRX|RNGFND|RPM"
    r"|SCHED_|SCR_|SERIAL|SERVO|SIM_|SR\d_|STAT_|SYSID_|TEMP|VISO|VTX|WENC"
)
"""Beginnings of names that concern the vehicle's hardware, calibration, ports and logs,
or that cannot be written: the twin has its airframe's."""
_WORLD = "SIM_"
_WIND = re.compile(r"SIM_WIND_")
_OURS = "gym-sitl"
"""In the firmware's name of a log of this simulator."""
_SHOWN = 8


@dataclass
class Taken:
    """Parameters of a log."""

    values: FileValues = field(default_factory=FileValues)
    """Of the beginning of the flight, as the twin takes them."""
    changes: list[tuple[float, str, float]] = field(default_factory=list)
    """(Time since arming [s], name, value) of those that were changed in flight."""
    missing: list[str] = field(default_factory=list)
    """Names that ours lacks, of those that say how it is flown."""
    idle: list[str] = field(default_factory=list)
    """Those that ours has, but which do nothing, and were not at ArduPilot's default."""
    own: int = 0
    """How many are the airframe's own affair."""

    def notes(self) -> list[str]:
        """In words, those that ours lacks first."""
        found = []
        if self.missing:
            found.append(f"{_counted(self.missing)} of the log not in this autopilot: {_some(self.missing)}")
        if self.idle:
            found.append(f"{_counted(self.idle)} of the log without effect in this autopilot: {_some(self.idle)}")
        found.append(
            f"{len(self.values)} parameters are the log's; {self.own} that tell of hardware, calibration, ports and "
            "logs are the airframe's"
        )
        return found


def taken(log: FlightLog, table: Table) -> Taken:
    """What a twin takes over.

    Args:
        log: the flight.
        table: of the twin's firmware.
    """
    found = Taken()
    rows = log.every("PARM")
    assert rows is not None
    defaults = rows["Default"] if "Default" in rows else [math.nan] * len(rows)
    is_ours = _OURS in log.columns.firmware
    first: dict[str, float] = {}
    for time, full, value, default in zip(log.since_arming(rows), rows["Name"], rows["Value"], defaults, strict=True):
        name, factor = str(full), 1.0
        if not math.isfinite(value):
            continue
        if name not in table and (renamed := here(name)) is not None and renamed[0] in table:
            name, factor = renamed
        if not _is_taken(name, is_ours):
            found.own += name not in first
            first.setdefault(name, value)
            continue
        if name in first:
            if value != first[name] and 0.0 <= time <= log.span.length - 1e-3:
                found.changes.append((float(time), name, float(factor * value)))
                first[name] = value
            elif time < 0.0:
                first[name] = value
                if name in table:
                    found.values[name] = float(factor * value)
            continue
        first[name] = value
        if name not in table:
            found.missing.append(name)
            continue
        if not table[name].has_effect and math.isfinite(default) and value != default:
            found.idle.append(name)
        found.values[name] = float(factor * value)
    found.changes = [change for change in found.changes if change[1] in table]
    names = set(rows["Name"].tolist())
    for axis in ("RLL", "PIT", "YAW"):  # before 4.0 the rates that are asked for were not filtered
        if f"ATC_RAT_{axis}_FILT" in names:
            found.values[f"ATC_RAT_{axis}_FLTT"] = 0.0
    return found


def _is_taken(name: str, is_ours: bool) -> bool:
    if name.startswith(_WORLD):
        return is_ours or _WIND.match(name) is not None
    return _OWN.match(name) is None


def _counted(names: list[str]) -> str:
    return f"{len(names)} parameter{'s' * (len(names) != 1)}"


def _some(names: list[str]) -> str:
    return ", ".join(names[:_SHOWN]) + (", ..." if len(names) > _SHOWN else "")
