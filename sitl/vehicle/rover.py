# SPDX-License-Identifier: BSD-3-Clause
"""The rover as a kind of vehicle: its record, its core's entries, and where what others need of it is."""

from __future__ import annotations

from collections.abc import Sequence

from ..autopilot.rover.firmware import FIRMWARE, update
from ..autopilot.rover.state import Autopilot
from ..core.kernels import law, unit
from ..physics.native.rover import pieces
from ..physics.native.rover.init import init
from ..physics.native.rover.state import Physics
from ..physics.native.rover.step import THROTTLE_OUTPUT, step
from ..vehicles import RoverAirframe
from . import sim_parameters
from .advance import advance_ticks, fly_tick
from .kind import Kind
from .record import Vehicle

GROUND_ROVER, BOAT = 10, 11
"""MAV_TYPE"""


class Rover(Vehicle):
    """A rover."""

    physics: Physics
    autopilot: Autopilot


@law
def drive(fleet: Sequence[Rover], index: int) -> None:
    """What follows a tick of physics."""
    fly_tick(fleet, index, update)


@unit
def advance(fleet: Sequence[Rover], index: int, ticks: int) -> None:
    """Up to ``ticks`` ticks of physics and autopilot."""
    advance_ticks(fleet, index, ticks, step, drive)


@unit
def fly(fleet: Sequence[Rover], index: int) -> None:
    """One tick of the autopilot after a tick of any physics."""
    drive(fleet, index)


def motor_output(v: Rover) -> float:
    """Control of the throttle, -1 .. 1."""
    return float(v.actuators.controls[THROTTLE_OUTPUT])


ROVER = Kind(
    firmware=FIRMWARE,
    airframe=RoverAirframe,
    record=Rover,
    advance=advance,
    fly=fly,
    step=step,
    pieces=pieces,
    init_physics=init,
    apply_sim_parameters=sim_parameters.apply,
    default_frame="erle_rover",
    mav_type=GROUND_ROVER,
    other_mav_types=(BOAT,),
    flies=False,
    has_reversible_outputs=True,
    motor_output=motor_output,
    engines={"pybullet": "sitl.physics.pybullet.rover:BulletRover", "jsbsim": "sitl.physics.jsbsim.rover:make"},
    demo_script="mavsdk_rover.py",
    programs={"ardupilot": "ardurover", "px4": "px4"},
    flight_parameters=("WP_", "CRUISE_SPEED", "TURN_", "RTL_", "MIS_", "LOIT_", "CIRC_", "GUID_"),
    parts={
        "mavlink": "sitl.bridge.rover.profile:PROFILE",
        "logs": "sitl.logs.dataflash.rover:LOGS",
        "environments": "sitl.envs.robots.rover:ROBOT",
    },
)
