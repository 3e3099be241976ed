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
    wanted = throttle(sticks, p)
    if ground.spool_by_stick(ap.arming, sticks.throttle_zero, control.motors):
        attitude.reset_yaw_target(control.attitude, ap.estimate.yaw)
        wanted = 0.0
    lean_max = math.radians(p.ANGLE_MAX * 0.01)
    lean = pilot.lean_angles(sticks, lean_max, lean_max)
    attitude.input_euler_roll_pitch_yaw_rate(control, ap.estimate, p, lean, sticks.yaw_rate)
    throttle_mix.set_throttle_out(control, p, wanted, True, p.PILOT.THR_FILT)


MODE = CopterMode(number=STABILIZE, name="STABILIZE", run=run, manual_throttle=True, needs_pilot=True)
