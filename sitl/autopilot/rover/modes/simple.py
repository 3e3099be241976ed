# SPDX-License-Identifier: BSD-3-Clause
"""SIMPLE: the stick points where to drive, seen from the heading when armed (SIMPLE_TYPE 0) or from north (1)."""

from __future__ import annotations

from ....core.kernels import law
from ....core.scalars import wrap_2pi
from .. import pilot
from ..control import speed
from . import drive

FROM_FIRST_HEADING = 0


@law
def note_heading(ap):
    """On arming: forwards is where the nose points."""
    ap.modes.simple.first_heading = ap.estimate.euler[2]
    ap.modes.simple.heading = ap.estimate.euler[2]


@law
def run(v):
    """One period; with the stick released the last heading stays."""
    ap = v.autopilot
    simple = ap.modes.simple
    heading, wanted = pilot.heading_and_speed(ap)
    if int(ap.params.SIMPLE_TYPE) == FROM_FIRST_HEADING:
        heading = wrap_2pi(heading + float(simple.first_heading))
    if wanted > 0.0:
        simple.heading = heading
    drive.to_heading(v, float(simple.heading))
    speed.drive(v, wanted)
