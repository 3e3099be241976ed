# SPDX-License-Identifier: BSD-3-Clause
"""SIMPLE: the stick is the direction, relative to the heading at arming (SIMPLE_TYPE 0) or to north (1)."""

from __future__ import annotations

from ....core.kernels import law
from ....core.scalars import wrap_2pi
from .. import pilot
from ..control import motors
from ..control.steering import out_from_heading
from ..state import Vehicle
from . import drive
from .mode import RoverMode
from .state import SimpleState

SIMPLE = 7

FROM_FIRST_HEADING = 0


@law
def note_heading(simple: SimpleState, yaw: float) -> None:
    """On arming: forwards is where the nose points [rad]."""
    simple.first_heading = yaw
    simple.heading = yaw


@law
def run(v: Vehicle) -> None:
    """One period; with the stick released the last heading stays."""
    ap = v.autopilot
    simple = ap.modes.simple
    control, p = ap.control, ap.params
    wanted = pilot.heading_and_speed(ap.modes.pilot, p)
    if wanted.speed > 0.0:
        from_first = int(p.SIMPLE_TYPE) == FROM_FIRST_HEADING
        simple.heading = wrap_2pi(wanted.heading + simple.first_heading) if from_first else wanted.heading
    motors.set_steering(control.motors, out_from_heading(control, ap.estimate, simple.heading, p.ATC))
    drive.at_speed(v, wanted.speed)


MODE = RoverMode(number=SIMPLE, name="SIMPLE", run=run, needs_position=True, manual_input=True)
