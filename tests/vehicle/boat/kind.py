# SPDX-License-Identifier: BSD-3-Clause
"""The boat as a kind of vehicle: what a package names in the entry point group ``sitl.kinds``."""

from __future__ import annotations

from collections.abc import Sequence

from sitl.core.kernels import law, unit
from sitl.vehicle import sim_parameters
from sitl.vehicle.advance import advance_ticks, fly_tick
from sitl.vehicle.kind import Kind
from sitl.vehicle.record import Vehicle

from .firmware import FIRMWARE, Autopilot, update
from .physics import BoatAirframe, Physics, init, step


class Boat(Vehicle):
    """A boat."""

    physics: Physics
    autopilot: Autopilot


@law
def sail(fleet: Sequence[Boat], index: int) -> None:
    """What follows a tick of physics."""
    fly_tick(fleet, index, update)


@unit
def advance(fleet: Sequence[Boat], index: int, ticks: int) -> None:
    """Up to ``ticks`` ticks of physics and autopilot."""
    advance_ticks(fleet, index, ticks, step, sail)


@unit
def fly(fleet: Sequence[Boat], index: int) -> None:
    """One tick of the autopilot alone."""
    sail(fleet, index)


def motor_output(v: Boat) -> float:
    """Of its one motor."""
    return float(v.actuators.controls[0])


BOAT = Kind(
    firmware=FIRMWARE,
    airframe=BoatAirframe,
    record=Boat,
    advance=advance,
    fly=fly,
    step=step,
    pieces=None,
    init_physics=init,
    apply_sim_parameters=sim_parameters.apply,
    default_frame="dinghy",
    mav_type=11,
    flies=False,
    has_reversible_outputs=True,
    motor_output=motor_output,
    parts={"mavlink": f"{__package__}.mavlink:PROFILE"},
)
