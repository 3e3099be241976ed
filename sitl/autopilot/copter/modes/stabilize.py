# SPDX-License-Identifier: BSD-3-Clause
"""STABILIZE: the sticks are lean angles and a turn rate, the throttle drives the motors."""

from __future__ import annotations

import math

from ....core.kernels import law
from .. import pilot
from ..control import attitude, throttle_mix
from ..control.motors import hover_throttle
from . import ground
from .mode import CopterMode

STABILIZE = 0


@law
def throttle(ap):
    """Motor throttle 0 .. 1 that the stick asks for."""
    return pilot.throttle_out(float(ap.modes.pilot.throttle_filtered), hover_throttle(ap.params.MOT))


@law
def run(v):
    """One tick."""
    ap = v.autopilot
    motors = ap.control.motors
    if ap.arming.armed == 0:
        motors.desired_spool = ground.SHUT_DOWN
    elif ap.modes.pilot.throttle_zero != 0:
        motors.desired_spool = ground.GROUND_IDLE
    else:
        motors.desired_spool = ground.UNLIMITED
    wanted = throttle(ap)
    state = motors.spool_state
    if state == ground.IS_SHUT_DOWN or state == ground.IS_GROUND_IDLE:
        attitude.reset_yaw_target(ap)
        wanted = 0.0
    elif state == ground.IS_UNLIMITED and motors.limit_throttle_lower == 0 and ap.arming.landed != 0:
        ground.set_landed(v, 0)
    most = math.radians(ap.params.ANGLE_MAX * 0.01)
    roll, pitch = pilot.lean_angles(ap, most, most)
    attitude.input_euler_roll_pitch_yaw_rate(ap, roll, pitch, float(ap.modes.pilot.yaw_rate))
    throttle_mix.set_throttle_out(ap, wanted, True, ap.params.PILOT.THR_FILT)


MODE = CopterMode(
    number=STABILIZE,
    name="STABILIZE",
    run=run,
    manual_throttle=True,
)
