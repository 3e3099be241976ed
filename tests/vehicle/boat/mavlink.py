# SPDX-License-Identifier: BSD-3-Clause
"""The boat's face on MAVLink."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

from sitl.bridge.autopilot_api import Note, Vector, Yaw
from sitl.bridge.base_autopilot import BaseAutopilot
from sitl.bridge.profile import Profile
from sitl.bridge.services import command_table
from sitl.bridge.services.setpoints import SetpointService
from sitl.bridge.telemetry.heartbeat import ACTIVE, ARMED, CUSTOM_MODE, Heartbeat, fill_heartbeat
from sitl.bridge.telemetry.shell import CAPABILITIES
from sitl.core.kernels import law
from sitl.vehicle.record import Vehicle

from .firmware import AHEAD, MODES

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

    def texts_of(self, code: int, a: float, b: float) -> Sequence[Note]:
        return []

    def set_servo(self, number: int, pulse: int) -> bool:
        return False

    def change_speed(self, kind: int, speed: float) -> bool:
        return False

    def guided_position(self, place: Vector, yaw: Yaw | None) -> bool:
        return False

    def guided_stop(self) -> bool:
        return False


@law
def heartbeat(m: Heartbeat, v: Vehicle) -> bool:
    """HEARTBEAT: a boat, its mode, armed or not."""
    base = CUSTOM_MODE | (ARMED if v.autopilot.arming.armed else 0)
    return fill_heartbeat(m, v, SURFACE_BOAT, base, ACTIVE)


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
    texts={},
    sticks=(),
    messages=(heartbeat,),
    autopilot=BoatAutopilot,
)
