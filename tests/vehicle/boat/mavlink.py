# SPDX-License-Identifier: BSD-3-Clause
"""The boat's face on MAVLink."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

from sitl.bridge.autopilot_api import Vector
from sitl.bridge.base_autopilot import BaseAutopilot
from sitl.bridge.core_link import CoreUnits
from sitl.bridge.firmware_profile import Profile
from sitl.bridge.services import command_table
from sitl.bridge.services.rc import rc_channels_override
from sitl.bridge.services.setpoint_messages import SetpointService
from sitl.bridge.telemetry.builder import compiled
from sitl.bridge.telemetry.heartbeat import Heartbeat, fill_heartbeat
from sitl.bridge.telemetry.shell import CAPABILITIES
from sitl.bridge.wire.choose import choose_builder, choose_taker, choose_targets
from sitl.bridge.wire.fleet import run_slots
from sitl.bridge.wire.link import Instruments, Limits, Links, receive_port, run_vehicle, transmit_links
from sitl.core.kernels import law, unit
from sitl.core.mavlink import MavModeFlag, MavState
from sitl.vehicle.record import Vehicle

from .firmware import AHEAD, MODES
from .kind import Boat, advance

SURFACE_BOAT = 11


class BoatAutopilot(BaseAutopilot):
    """What the services call."""

    def arm(self, force: bool) -> bool:
        self._v.autopilot.arming.armed = 1
        return True

    def disarm(self, force: bool) -> bool:
        self._v.autopilot.arming.armed = 0
        return True

    def run_prearm_checks(self) -> None: ...

    def set_mode(self, number: int) -> bool:
        return number == AHEAD

    def set_servo(self, number: int, pulse: int) -> bool:
        return False

    def change_speed(self, kind: int, speed: float) -> bool:
        return False

    def guided_position(self, place: Vector) -> bool:
        return False


@law
def heartbeat(m: Heartbeat, v: Vehicle) -> bool:
    """HEARTBEAT: a boat, its mode, armed or not."""
    base = MavModeFlag.CUSTOM_MODE_ENABLED | (MavModeFlag.SAFETY_ARMED if v.autopilot.arming.armed else 0)
    return fill_heartbeat(m, v, SURFACE_BOAT, base, MavState.ACTIVE)


BUILDERS = compiled((heartbeat,))
TAKERS = (rc_channels_override,)
build, take, target = choose_builder(BUILDERS), choose_taker(TAKERS), choose_targets(TAKERS)


@unit
def receive(fleet: Sequence[Boat], index: int, port: int) -> None:
    receive_port(fleet[index], port, take, target)


@unit
def transmit(fleet: Sequence[Boat], index: int, ports: int, count: int, number: int) -> None:
    transmit_links(fleet[index], Links(ports, count), number, build)


@unit
def run(
    fleet: Sequence[Boat], index: int, ports: int, count: int, ranging: int, sampler: int, until_us: int, shell_us: int
) -> None:
    run_vehicle(
        fleet, index, Links(ports, count), Instruments(ranging, sampler), Limits(until_us, shell_us), advance, transmit
    )


@unit
def run_all(fleet: Sequence[Boat], index: int, last: int, slots: int, ranging: int) -> None:
    run_slots(fleet, index, last, slots, ranging, receive, run)


UNITS = CoreUnits(receive, transmit, run, run_all, BUILDERS, TAKERS)
_VEHICLE: dict[int, Any] = {**command_table.COMMANDS, **command_table.COMMANDS}
PROFILE = Profile(
    firmware="Boat",
    mav_type=SURFACE_BOAT,
    capabilities=CAPABILITIES,
    modes=MODES,
    auto=-1,
    guided=-1,
    rtl=-1,
    groups={6: ("POSITION", ("LOCAL_POSITION_NED",))},
    commands=_VEHICLE,
    set_points=SetpointService,
    core=UNITS,
    autopilot=BoatAutopilot,
)
