# SPDX-License-Identifier: BSD-3-Clause
"""Whether the vehicle at the other end is a simulator: only then may an environment reset it without being told to.

A reset disarms by force and reboots, whatever the vehicle is doing: in the air it would fall. What proves a simulator
is a parameter that flight controllers do not have: ArduPilot's SIM_ parameters are compiled into its simulator builds
only (https://ardupilot.org/dev/docs/sitl-parameters.html), and this simulator has some of them. Reading one changes
nothing on any vehicle.
"""

from __future__ import annotations

from typing import Any

from sitl.client.connection import PROOF, Connection

from .errors import NotASimulatorError

SIMULATOR, REBOOT = "simulator", "reboot"
RESETS = (SIMULATOR, REBOOT)
"""Values of the option ``reset``: reset only what proves to be a simulator; reboot whatever answers."""


def is_simulator(link: Connection) -> bool:
    """Whether the vehicle has a parameter that only simulators have; it is asked now."""
    return link.parameter(PROOF) is not None


def refusal(link: Connection) -> NotASimulatorError:
    """The error for a vehicle that has not proved to be a simulator."""
    heard: Any = link.inbox
    mode = f"{'armed' if heard.armed else 'disarmed'}, in mode {heard.mode}" if heard.mode >= 0 else "no HEARTBEAT yet"
    return NotASimulatorError(
        f"connection {link.name}: the vehicle (system {heard.system}, {mode}) does not prove to be a simulator: it "
        f"does not give its parameter {PROOF}. It was only asked questions. A reset would disarm it by force and "
        "reboot it, in the air, too: that is done to simulators only (sitl run, ArduPilot's SITL). For a vehicle that "
        f'may be treated so, whatever it is: reset="{REBOOT}" when the environment is made'
    )
