# SPDX-License-Identifier: BSD-3-Clause
"""STABILIZE: the sticks are lean angles and a turn rate, the throttle drives the motors."""

from __future__ import annotations

import math

from ....core.kernels import law
from .. import pilot
from ..control import attitude, throttle_mix
from ..control.motors import hover_throttle
from ..parameters import Parameters
from ..state import Vehicle
from . import ground
from .mode import CopterMode
from .state import PilotState

STABILIZE = 0


@law
def throttle(sticks: PilotState, p: Parameters) -> float:
    """Motor throttle 0 .. 1 that the stick asks for."""
    return pilot.throttle_out(sticks.throttle_filtered, pilot.throttle_middle(p), hover_throttle(p.MOT))


@law
def run(v: Vehicle) -> None:
    """One tick."""
    ap = v.autopilot
    control, sticks, p = ap.control, ap.modes.pilot, ap.params
    motors = control.motors
    if not ap.arming.armed:
        motors.desired_spool = ground.SHUT_DOWN
    elif sticks.throttle_zero:
        motors.desired_spool = ground.GROUND_IDLE
    else:
        motors.desired_spool = ground.UNLIMITED
    wanted = throttle(sticks, p)
    state = motors.spool_state
    if state == ground.IS_SHUT_DOWN or state == ground.IS_GROUND_IDLE:
        attitude.reset_yaw_target(control.attitude, ap.estimate.yaw)
        wanted = 0.0
    elif state == ground.IS_UNLIMITED and not motors.limit_throttle_lower and ap.arming.landed:
        ground.set_landed(ap.arming, False)
    lean_max = math.radians(p.ANGLE_MAX * 0.01)
    lean = pilot.lean_angles(sticks, lean_max, lean_max)
    attitude.input_euler_roll_pitch_yaw_rate(control, ap.estimate, p, lean, sticks.yaw_rate)
    throttle_mix.set_throttle_out(control, p, wanted, True, p.PILOT.THR_FILT)


MODE = CopterMode(number=STABILIZE, name="STABILIZE", run=run, manual_throttle=True)
