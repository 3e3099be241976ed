# SPDX-License-Identifier: BSD-3-Clause
"""Messages that the core cannot build: with texts, or of what is not in the vehicle's record."""

from __future__ import annotations

from collections.abc import Callable
from hashlib import sha1

from ...autopilot import relays
from ...core.records import as_bytes
from ...version import __version__
from .. import metadata
from ..autopilot_api import Vehicle
from ..dialect import message
from ..mavlink_firmware import MavlinkFirmware
from .high_latency import high_latency
from .sensors import SimState, SimStateWithSpeed, fill_sim_state, fill_simstate
from .units import boot_ms

ShellBuilder = Callable[[Vehicle, MavlinkFirmware], bytes]
"""``build(vehicle, profile)``: the payload now; empty when there is nothing to say."""

MISSION_FLOAT, PARAM_FLOAT, MISSION_INT, COMMAND_INT, FTP = 0x1, 0x2, 0x4, 0x8, 0x20
COMPASS_CALIBRATION, FENCE, RALLY = 0x1000, 0x4000, 0x8000
SET_ATTITUDE, SET_LOCAL_POSITION, SET_GLOBAL_POSITION, TERRAIN, TERMINATION = 0x40, 0x80, 0x100, 0x200, 0x800
MAVLINK2 = 0x2000
CAPABILITIES = MISSION_FLOAT | PARAM_FLOAT | MISSION_INT | COMMAND_INT | FTP
CAPABILITIES |= SET_ATTITUDE | SET_LOCAL_POSITION | SET_GLOBAL_POSITION | MAVLINK2 | COMPASS_CALIBRATION | FENCE | RALLY
"""What every firmware can: ArduPilot's. Compass calibrations are refused."""

FLIGHT_VERSION = (4, 7, 0, 0)
"""Major, minor, patch, type (0: development).

The ArduPilot whose behaviour and parameter names this firmware follows.
"""
VERSION_DIGITS = tuple(sha1(f"gym-sitl {__version__}".encode()).hexdigest()[:8].encode())
"""What tells this program's versions apart: eight hexadecimal digits, as tools expect of a commit."""


def autopilot_version(vehicle: Vehicle, profile: MavlinkFirmware) -> bytes:
    """AUTOPILOT_VERSION: capabilities and version."""
    major, minor, patch, kind = FLIGHT_VERSION
    return message("AUTOPILOT_VERSION").payload(
        capabilities=profile.capabilities,
        flight_sw_version=major << 24 | minor << 16 | patch << 8 | kind,
        flight_custom_version=VERSION_DIGITS,
        uid=1,
    )


def banner(profile: MavlinkFirmware) -> str:
    """The text that tells firmware and version."""
    major, minor, patch, _ = FLIGHT_VERSION
    return f"{profile.firmware} V{major}.{minor}.{patch}-dev (gym-sitl {__version__})"


def simstate(vehicle: Vehicle, profile: MavlinkFirmware) -> bytes:
    """SIMSTATE of a vehicle whose physics is at the other end of a link: it is asked."""
    m = SimState()
    fill_simstate(m, vehicle.truth())
    return bytes(as_bytes(m, m.dtype))


def sim_state(vehicle: Vehicle, profile: MavlinkFirmware) -> bytes:
    """SIM_STATE of such a vehicle."""
    m = SimStateWithSpeed()
    fill_sim_state(m, vehicle.truth())
    return bytes(as_bytes(m, m.dtype))


def component_metadata(vehicle: Vehicle, profile: MavlinkFirmware) -> bytes:
    """COMPONENT_METADATA: the file that names the parameters' descriptions, to be read by FTP."""
    general = metadata.files(vehicle.firmware.table)[metadata.GENERAL]
    return message("COMPONENT_METADATA").payload(
        time_boot_ms=int(vehicle.v.time_us) // 1000,
        file_crc=metadata.file_crc(general),
        uri=metadata.uri(metadata.GENERAL).encode(),
    )


def relay_status(vehicle: Vehicle, profile: MavlinkFirmware) -> bytes:
    """RELAY_STATUS: which relays there are and which of them are on, a bit each."""
    values = vehicle.parameters
    fitted = relays.fitted(values) if relays.MASK in values.table else []
    return message("RELAY_STATUS").payload(
        time_boot_ms=boot_ms(int(vehicle.v.time_us)),
        on=sum(1 << relay for relay in fitted if relays.is_on(values, relay)),
        present=sum(1 << relay for relay in fitted),
    )


SHELL_BUILDERS: dict[str, ShellBuilder] = {
    "AUTOPILOT_VERSION": autopilot_version,
    "COMPONENT_METADATA": component_metadata,
    "HIGH_LATENCY2": high_latency,
    "RELAY_STATUS": relay_status,
}
"""What the shell builds for every vehicle, by the message's name."""


def shell_builders(vehicle: Vehicle) -> dict[str, ShellBuilder]:
    """What the shell builds for a vehicle, by the message's name; it comes before a law for the same message."""
    of_truth: dict[str, ShellBuilder] = {"SIMSTATE": simstate, "SIM_STATE": sim_state}
    return SHELL_BUILDERS if vehicle.has_truth_in_record else {**SHELL_BUILDERS, **of_truth}
