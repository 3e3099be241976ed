# SPDX-License-Identifier: BSD-3-Clause
"""What the controllers need once, at boot (gains are read live from the parameters)."""

from __future__ import annotations

from ....core.kernels import law
from .altitude import set_max_speed_accel_d
from .attitude import relax
from .position import set_max_speed_accel_ne


@law
def init(ap):
    """Filters, compensation and limits to sane starts; harmless when called again on the ground or after a
    parameter change.
    """
    motors = ap.control.motors
    if motors.compensation_gain <= 0.0:
        motors.voltage_ratio = 1.0
        motors.lift_max = 1.0
        motors.compensation_gain = 1.0
        ap.control.attitude.mix = float(ap.params.ATC.THR_MIX_MAN)
        ap.control.attitude.mix_desired = float(ap.params.ATC.THR_MIX_MAN)
        ap.control.attitude.cos_lean = 1.0
        relax(ap)
    if ap.control.pos_ne.speed_max <= 0.0:
        set_max_speed_accel_ne(ap, float(ap.params.WPNAV.SPEED) * 0.01, float(ap.params.WPNAV.ACCEL) * 0.01)
    if ap.control.pos_d.speed_up <= 0.0:
        set_max_speed_accel_d(
            ap,
            float(ap.params.WPNAV.SPEED_DN) * 0.01,
            float(ap.params.WPNAV.SPEED_UP) * 0.01,
            float(ap.params.WPNAV.ACCEL_Z) * 0.01,
        )
