# SPDX-License-Identifier: BSD-3-Clause
"""Which service does what missions and switches ask of the things that are fitted to a vehicle."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

from ...autopilot import payload
from ...autopilot.aux_switch import HIGH, LOW, MIDDLE
from ...autopilot.mission import item as commands
from ...autopilot.mission.item import MissionItem
from ...core.mavlink import MavCmd
from ..host import Host
from .camera import CameraService
from .gripper import GripperService
from .mount import MountService
from .outputs import OutputService
from .parachute import ParachuteService
from .service import Service
from .sprayer import SprayerService
from .winch import WinchService

CARRIED_OUT_BY: dict[int, type[Service]] = {
    **dict.fromkeys(commands.CAMERA_COMMANDS, CameraService),
    **dict.fromkeys((*commands.MOUNT_COMMANDS, *commands.ROI_COMMANDS), MountService),
    MavCmd.DO_PARACHUTE: ParachuteService,
    MavCmd.DO_GRIPPER: GripperService,
    MavCmd.DO_SPRAYER: SprayerService,
    MavCmd.DO_WINCH: WinchService,
}
"""By command of a mission; outputs and relays do the others."""


def _grip(gripper: GripperService, position: int) -> None:
    if position == HIGH:
        gripper.grab()
    elif position == LOW:
        gripper.release()


_SWITCHES: dict[int, tuple[type[Service], Callable[[Any, int], None]]] = {
    payload.SWITCH_GRIPPER: (GripperService, _grip),
    payload.SWITCH_SPRAYER: (SprayerService, lambda sprayer, position: sprayer.run(position == HIGH, True)),
    payload.SWITCH_WINCH: (WinchService, WinchService.enable),
    payload.SWITCH_WINDING: (WinchService, WinchService.control),
    payload.SWITCH_FOLD: (MountService, MountService.fold),
    payload.SWITCH_LOCK: (MountService, MountService.lock),
    payload.SWITCH_CAMERA: (
        CameraService,
        lambda camera, position: camera.take_picture() if position == HIGH else None,
    ),
}
"""By function."""
_PARACHUTE = (payload.SWITCH_PARACHUTE_ENABLE, payload.SWITCH_PARACHUTE_RELEASE, payload.SWITCH_PARACHUTE)


def run_aux_function(bridge: Host, item: MissionItem) -> None:
    """A mission's DO_AUX_FUNCTION: parameter 1 a function of switches, 2 its position (0 low, 1 middle, 2 high)."""
    function, position = int(item.p1), LOW + int(item.p2)
    if position in (LOW, MIDDLE, HIGH):
        bridge.autopilot.run_aux_function(function, position)
        bridge.say_pending()


def switched(bridge: Host, function: int, position: int) -> None:
    """A switch with one of these functions was moved."""
    if function in payload.SWITCH_RELAYS:
        if position != MIDDLE:
            bridge.get(OutputService).set_relay(payload.SWITCH_RELAYS[function], float(position == HIGH))
        return
    if function in _PARACHUTE:
        bridge.get(ParachuteService).switched(function, position)
        return
    service, act = _SWITCHES[function]
    act(bridge.get(service), position)
