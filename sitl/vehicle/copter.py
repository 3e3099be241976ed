# SPDX-License-Identifier: BSD-3-Clause
"""The multicopter as a kind of vehicle: its record, its core's entries, and where what others need of it is."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from ..autopilot.copter.firmware import FIRMWARE, update
from ..autopilot.copter.state import Autopilot
from ..autopilot.events import HIT_GROUND, emit
from ..core.kernels import inlined, unit
from ..physics.native.copter import pieces
from ..physics.native.copter.init import init
from ..physics.native.copter.state import Physics
from ..physics.native.copter.step import step
from ..vehicles import CopterAirframe
from . import sim_parameters
from .advance import advance_ticks, fly_tick
from .kind import Kind
from .record import Vehicle

QUADROTOR = 2
OTHER_MULTIROTORS = (13, 14, 15, 29, 35)
"""MAV_TYPE of hexarotor, octorotor, tricopter, dodecarotor, decarotor."""


class Copter(Vehicle):
    """A copter."""

    physics: Physics
    autopilot: Autopilot


@unit
def advance(fleet: Sequence[Copter], index: int, ticks: int) -> None:
    """Up to ``ticks`` ticks of physics and autopilot."""
    advance_ticks(fleet, index, ticks, step, fly_after_touch)


@unit
def fly(fleet: Sequence[Copter], index: int) -> None:
    """One tick of the autopilot after a tick of any physics."""
    fly_after_touch(fleet, index)


@inlined
def fly_after_touch(fleet: Sequence[Copter], index: int) -> None:
    """What follows a tick of physics."""
    report_touch(fleet[index])
    fly_tick(fleet, index, update)


@inlined
def report_touch(vehicle: Copter) -> None:
    """HIT_GROUND when the vehicle came down hard in this tick."""
    ground = vehicle.physics.ground
    if ground.hit_count > 0 and ground.hit_time_us == vehicle.time_us:
        emit(vehicle.autopilot.events, vehicle.time_us, HIT_GROUND, float(ground.hit_speed), 0.0)


def apply_sim_parameters(v: Copter) -> None:
    """SIM_ parameters of all kinds, and a copter's failing motors."""
    sim_parameters.apply(v)
    params, rotors = v.autopilot.params, v.physics.rotors
    for k in range(len(rotors.efficiency)):
        fails = int(params.SIM.ENGINE_FAIL) >> k & 1
        rotors.efficiency[k] = params.SIM.ENGINE_MUL if fails else 1.0


def motor_output(v: Copter) -> float:
    """Mean control of the rotors, 0 .. 1."""
    count = int(v.physics.airframe.rotor_count)  # type: ignore[attr-defined]
    return float(np.mean(v.actuators.controls[:count]))


COPTER = Kind(
    firmware=FIRMWARE,
    airframe=CopterAirframe,
    record=Copter,
    advance=advance,
    fly=fly,
    step=step,
    pieces=pieces,
    init_physics=init,
    apply_sim_parameters=apply_sim_parameters,
    default_frame="erle_copter",
    mav_type=QUADROTOR,
    other_mav_types=OTHER_MULTIROTORS,
    flies=True,
    has_reversible_outputs=False,
    motor_output=motor_output,
    engines={"pybullet": "sitl.physics.pybullet.engine:BulletEngine", "jsbsim": "sitl.physics.jsbsim.copter:make"},
    demo_script="mavsdk_mission.py",
    programs={"ardupilot": "arducopter", "px4": "px4"},
    ardupilot_parameters={"FRAME_CLASS": 1},
    flight_parameters=(
        "WPNAV_", "WP_", "RTL_", "LAND_", "LOIT_", "PILOT_", "TKOFF_", "GUID_", "AUTO_", "MIS_", "CIRCLE_",
    ),
    parts={
        "mavlink": "sitl.bridge.copter.profile:PROFILE",
        "logs": "sitl.logs.dataflash.copter:LOGS",
        "environments": "sitl.envs.robots.copter:ROBOT",
    },
)  # fmt: skip
