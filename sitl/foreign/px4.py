# SPDX-License-Identifier: BSD-3-Clause
"""How PX4's simulator program is started for a vehicle of ours, over the HIL link.

``px4 -i N -d ETC`` connects to the simulator on TCP port 4560 + N of this machine and speaks MAVLink from UDP port
14580 + N to 14540 + N (for programs) and to 14550 (for ground stations). PX4_SIM_MODEL none_iris is an airframe that
starts no simulator; PX4_PARAM_name sets a parameter. Sources: https://docs.px4.io/main/en/simulation/,
ROMFS/px4fmu_common/init.d-posix.
"""

from __future__ import annotations

import contextlib
import os
import re
import socket
from collections.abc import Mapping
from pathlib import Path

from ..bridge.hil.protocol import BASE_PORT
from ..errors import OptionError
from ..physics.native.power_on import Home
from ..vehicles import Airframe, CopterAirframe, RoverAirframe
from . import px4_airframe, px4_rover
from .process import HOST, AutopilotProcess

COPTER_MODEL = "none_iris"
SIMULATOR = "mavlink"
"""PX4_SIMULATOR: none of those that its start script knows, so that it waits for one on its HIL port."""
PROGRAMS_PORT, OWN_PORT, STATIONS_PORT = 14540, 14580, 14550
"""UDP: where it sends to programs, from where, and where to ground stations; the first two are + N."""
LINKS_FILE = "px4-rc.mavlink"
"""What its start script runs to begin with MAVLink: the first of this name in PATH."""
INSTANCES = 10
"""Number of instances: from 10 on all send to port 14549, where programs cannot distinguish them."""


def model_of(airframe: Airframe) -> tuple[str, dict[str, float]]:
    """PX4_SIM_MODEL, and parameters with which PX4 flies or drives this airframe.

    Raises:
        OptionError: it is neither a copter nor a rover.
    """
    if isinstance(airframe, CopterAirframe):
        return COPTER_MODEL, px4_airframe.parameters(airframe)
    if isinstance(airframe, RoverAirframe):
        return px4_rover.model(airframe), px4_rover.parameters(airframe)
    raise OptionError(f"airframe {airframe.name} is a {airframe.kind}: px4 flies copters and drives rovers here")


def _worded(value: float) -> str:
    """For its ``param set``, which reads a whole number up to the first character that is no digit."""
    return str(int(value)) if value == int(value) else f"{value:.9g}"


def unknown_names(process: AutopilotProcess, given: Mapping[str, float]) -> list[str]:
    """Those of the parameters that a user gave it that it does not have, by its output: it has set all of them before
    its MAVLink begins. Its start script sets some that a program may not have, too; those do not count."""
    said = set(re.findall(r"Parameter (\w+) not found", process.output()))
    return [name for name in given if name in said]


def programs_port(instance: int) -> int:
    """UDP port that an instance sends to for programs."""
    return PROGRAMS_PORT + min(instance, INSTANCES - 1)


def free_instance() -> int:
    """The first instance of which all ports are free.

    Raises:
        OptionError: there is none.
    """
    for number in range(INSTANCES):
        with contextlib.ExitStack() as stack, contextlib.suppress(OSError):
            for kind, port in (
                (socket.SOCK_STREAM, BASE_PORT),
                (socket.SOCK_DGRAM, PROGRAMS_PORT),
                (socket.SOCK_DGRAM, OWN_PORT),
            ):
                probe = stack.enter_context(socket.socket(socket.AF_INET, kind))
                probe.setsockopt(socket.SOL_SOCKET, socket.SO_REUSEADDR, int(kind == socket.SOCK_STREAM))
                probe.bind((HOST, port + number))
            return number
    raise OptionError(f"px4: the ports of all instances from 0 to {INSTANCES - 1} are taken")


def start(
    program: Path,
    airframe: Airframe,
    home: Home,
    instance: int,
    *,
    speedup: float = 1.0,
    params: Mapping[str, float] | None = None,
    folder: Path | None = None,
    link: tuple[int, int] | None = None,
) -> AutopilotProcess:
    """Start it.

    Args:
        program: ``build/px4_sitl_default/bin/px4``, whose start-up files are in ``build/px4_sitl_default/etc``.
        airframe: a copter or a rover.
        home: where it stands.
        instance: number that gives its ports, and its MAV_SYS_ID less one.
        speedup: times the wall clock, by which it lengthens its time-outs.
        params: under PX4's names, over those that suit the airframe (``model_of``, ``px4_airframe.receiver``).
        folder: see ``AutopilotProcess``.
        link: UDP ports of its only MAVLink: its own, and the one that it speaks to; None: those of its instance.
    """
    model, own = model_of(airframe)
    values = {**px4_airframe.receiver(airframe), **own, **(params or {})}
    environment = {
        "PX4_SIM_MODEL": model,
        "PX4_SIMULATOR": SIMULATOR,
        "PX4_SIM_SPEED_FACTOR": f"{speedup:g}",
        "PX4_HOME_LAT": f"{home[0]:.9g}",
        "PX4_HOME_LON": f"{home[1]:.9g}",
        "PX4_HOME_ALT": f"{home[2]:.9g}",
        **{f"PX4_PARAM_{name}": _worded(value) for name, value in values.items()},
    }
    files = {}
    if link is not None:
        files[LINKS_FILE] = f"mavlink start -x -u {link[0]} -r 4000000 -f -m onboard -o {link[1]}\n"
        environment["PATH"] = os.pathsep.join(("{folder}", os.environ.get("PATH", os.defpath)))
    command = [str(program), "-i", str(instance), "-d", str(program.parent.parent / "etc")]
    return AutopilotProcess(command, files, environment, folder)
