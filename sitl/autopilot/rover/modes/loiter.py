# SPDX-License-Identifier: BSD-3-Clause
"""LOITER: stops and stays; drives back when it has drifted further than LOIT_RADIUS (LOIT_TYPE, LOIT_SPEED_GAIN)."""

from __future__ import annotations

import math

from ....core.kernels import law
from ....core.scalars import constrain, wrap_pi
from ..control import speed
from ..control.forward_speed import sense
from ..navigation import waypoint
from . import drive
from .numbers import ACCEPTED, INIT_FAILED

EITHER_WAY, FORWARDS, BACKWARDS = 0, 1, 2
"""LOIT_TYPE"""


@law
def start(v):
    """Enter; needs an origin."""
    ap = v.autopilot
    if ap.estimate.origin_set == 0:
        return INIT_FAILED
    loiter = ap.modes.loiter
    place = waypoint.stopping_point(ap)
    loiter.place[0], loiter.place[1] = place.x, place.y
    loiter.speed = sense(v).speed
    loiter.heading = ap.estimate.euler[2]
    loiter.distance = 0.0
    return ACCEPTED


@law
def aim(v):
    """Heading and speed back to the place, from beyond LOIT_RADIUS."""
    ap = v.autopilot
    p = ap.params
    loiter = ap.modes.loiter
    wanted = min((loiter.distance - p.LOIT.RADIUS) * p.LOIT.SPEED_GAIN, float(p.WP.SPEED))
    heading = math.atan2(loiter.place[1] - ap.estimate.pos[1], loiter.place[0] - ap.estimate.pos[0])
    error = wrap_pi(heading - float(ap.estimate.euler[2]))
    behind = abs(error) > 0.5 * math.pi
    if p.LOIT.TYPE == BACKWARDS or (behind and p.LOIT.TYPE == EITHER_WAY):
        heading = wrap_pi(heading + math.pi)
        error = wrap_pi(heading - float(ap.estimate.euler[2]))
        wanted = -wanted
    loiter.heading = heading
    # slower while it still has to turn: half the speed at a right angle
    loiter.speed = wanted * (1.0 - 0.5 * constrain(abs(error) / (0.5 * math.pi), 0.0, 1.0))


@law
def run(v):
    """One period."""
    ap = v.autopilot
    loiter = ap.modes.loiter
    north = float(loiter.place[0]) - float(ap.estimate.pos[0])
    east = float(loiter.place[1]) - float(ap.estimate.pos[1])
    loiter.distance = math.sqrt(north * north + east * east)
    if loiter.distance <= ap.params.LOIT.RADIUS:
        loiter.speed = speed.accel_limited(ap.control, 0.0, ap.params.ATC)
    else:
        aim(v)
    drive.to_heading(v, float(loiter.heading))
    speed.drive(v, float(loiter.speed))
