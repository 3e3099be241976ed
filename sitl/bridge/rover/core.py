# SPDX-License-Identifier: BSD-3-Clause
"""The rover with its clients in the compiled core."""

from __future__ import annotations

from collections.abc import Sequence

from ...core.kernels import unit
from ...vehicle.rover import Rover, advance
from ..core_link import CoreUnits
from ..services import odometry
from ..services.follow_target import follow_target
from ..services.landing_target import landing_target
from ..services.proximity import distance, obstacle_3d, obstacles
from ..services.rc import rc_channels_override
from ..telemetry.builder import compiled
from ..telemetry.flow import take_flow
from ..wire.choose import choose_builder, choose_taker, choose_targets
from ..wire.fleet import run_slots
from ..wire.link import Instruments, Limits, Links, receive_port, run_vehicle, transmit_links
from .joystick import manual_control
from .setpoints import attitude_target, other_position, position_target_global, position_target_local
from .status_messages import MESSAGES

BUILDERS = compiled(MESSAGES)
TAKERS = (
    position_target_local, position_target_global, attitude_target, rc_channels_override, manual_control,
    other_position, follow_target, landing_target, obstacles, distance, obstacle_3d, take_flow,
    *odometry.TAKERS,
)  # fmt: skip
build, take, target = choose_builder(BUILDERS), choose_taker(TAKERS), choose_targets(TAKERS)


@unit
def receive(fleet: Sequence[Rover], index: int, port: int) -> None:
    """Act on what the client at ``port`` sent."""
    receive_port(fleet[index], port, take, target)


@unit
def transmit(fleet: Sequence[Rover], index: int, ports: int, count: int, number: int) -> None:
    """Send the regular messages that are due, or one message."""
    transmit_links(fleet[index], Links(ports, count), number, build)


@unit
def run(
    fleet: Sequence[Rover], index: int, ports: int, count: int, ranging: int, sampler: int, until_us: int, shell_us: int
) -> None:
    """Advance; measure, send and log what falls due."""
    run_vehicle(
        fleet, index, Links(ports, count), Instruments(ranging, sampler), Limits(until_us, shell_us), advance, transmit
    )


@unit
def run_all(fleet: Sequence[Rover], index: int, last: int, slots: int, ranging: int) -> None:
    """Vehicles ``index`` .. ``last`` - 1 act on what their clients sent, and advance."""
    run_slots(fleet, index, last, slots, ranging, receive, run)


UNITS = CoreUnits(receive, transmit, run, run_all, BUILDERS, TAKERS)
