# SPDX-License-Identifier: BSD-3-Clause
"""How ArduPilot's simulator (``arducopter``, ``ardurover``) is started for a vehicle of ours.

Options: ``--model JSON:HOST`` sends servos to the simulator port and waits for answers, ``--sim-port-out`` names that
port, ``--base-port`` the TCP port of its first MAVLink connection (it waits there for a client before it boots),
``--defaults`` files of parameters, ``--start-time`` the date of its GPS, which is otherwise the wall clock's.
Sources: https://ardupilot.org/dev/docs/sitl-with-JSON.html, the program's --help.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from pathlib import Path

from ..autopilot.params.parm_files import text_of
from ..bridge.bridge import EPOCH_US
from ..core.constants import TICK_HZ
from ..physics.native.power_on import Home
from ..vehicle.kinds import KINDS
from ..vehicles import Airframe
from .process import GRACE_S, AutopilotProcess

SERIAL_PORTS = 8
"""Number of ports from the base port that it may listen on: TCP for its serial ports, and the last one, UDP, for RC."""
DEFAULTS = "vehicle.parm"
FASTEST = 1000.0
"""Speed-up at which it never waits for the wall clock."""
_RANGEFINDER = 100  # the simulator's own
_DOWN = 25
"""Orientation of a range-finder: pitched by -90 deg."""


LOG = "LOG_BACKEND_TYPE"


def unlogged(params: Mapping[str, float]) -> dict[str, float]:
    """Parameters of an ArduPilot with its on-board log off, unless they say something of it.

    A thread of its own writes the log in wall time, and the main loop meets it where it happens to be: flights of a
    copter then differ in their last bits. To write it takes a part of the autopilot's time, too.
    """
    return {LOG: 0.0, **params}


def defaults(airframe: Airframe, sees_ground: bool) -> str:
    """Parameters with which ArduPilot flies or drives this airframe, as a file.

    The airframe's own are ArduPilot's names already; a version that does not know a name ignores it. Its battery is its
    own, with the voltage of ours when full.
    """
    of_kind = KINDS[airframe.kind].ardupilot_parameters
    battery = float(airframe.value("battery_voltage_full"))
    values: dict[str, float] = {
        "SIM_RATE_HZ": TICK_HZ, "SIM_BATT_VOLTAGE": battery, **of_kind, **airframe.parameters
    }  # fmt: skip
    if sees_ground:
        low, high = float(airframe.value("rangefinder_min")), float(airframe.value("rangefinder_max"))
        values |= {
            "RNGFND1_TYPE": _RANGEFINDER, "RNGFND1_ORIENT": _DOWN, "RNGFND1_MIN": low, "RNGFND1_MAX": high,
            "RNGFND1_MIN_CM": round(100 * low), "RNGFND1_MAX_CM": round(100 * high),
        }  # fmt: skip
    return text_of(values)


def command(
    program: Path, home: Home, port: int, base: int, instance: int, speedup: float, files: Sequence[Path | str]
) -> list[str]:
    """Program and arguments.

    Args:
        program: ``arducopter`` or ``ardurover``.
        home: where position (0, 0, 0) of the physics is.
        port: UDP port of the physics on this machine.
        base: TCP port of its MAVLink.
        instance: adds to MAV_SYSID in ArduPilot's own way; its ports are given by the others.
        speedup: times the wall clock.
        files: files of parameters.
    """
    where = ",".join(f"{number:.9g}" for number in home)
    return [
        str(program), "--base-port", str(base), "--instance", str(instance), "--model", "JSON:127.0.0.1",
        "--sim-port-out", str(port), "--rc-in-port", str(base + SERIAL_PORTS - 1),
        "--start-time", str(EPOCH_US // 1_000_000), "--home", where, "--speedup", f"{speedup:g}",
        "--defaults", ",".join(map(str, files)), "--wipe",
    ]  # fmt: skip


def start(
    program: Path,
    airframe: Airframe,
    home: Home,
    port: int,
    base: int,
    *,
    instance: int = 0,
    speedup: float = FASTEST,
    sees_ground: bool = False,
    overrides: str = "",
    folder: Path | None = None,
) -> AutopilotProcess:
    """Start it; see ``command`` and ``defaults``. ``overrides`` is the text of a second file of parameters."""
    files = {DEFAULTS: defaults(airframe, sees_ground)}
    named: list[Path | str] = ["{folder}/" + DEFAULTS]
    if overrides:
        files["overrides.parm"] = overrides
        named.append("{folder}/overrides.parm")
    words = command(program, home, port, base, instance, speedup, named)
    grace_s = 0.0 if folder is None else GRACE_S  # it does not end while its physics stands, and leaves nothing behind
    return AutopilotProcess(words, files, {}, folder, grace_s)
