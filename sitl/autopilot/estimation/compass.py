# SPDX-License-Identifier: BSD-3-Clause
"""Which compass a filter works on: another one when its own has given no usable yaw for ten seconds."""

from __future__ import annotations

from ...core.border import Sensors
from ...core.kernels import law
from ...core.vectors import Vec3
from ..events import Events, emit
from ..params.firmware_parameters import Parameters
from ..params.system import Compass
from ..sensor_calibration import COMPASSES, differs, field_of, is_received
from . import magnetometer, noise
from .covariance import clear
from .estimator_events import EKF_COMPASS_CHANGED
from .magnetometer import TIMEOUT_US
from .state import BM, Ekf


@law
def is_used(k: int, params: Compass) -> bool:
    """Whether COMPASS_USE, USE2 or USE3 lets compass ``k`` count."""
    if k == 0:
        return params.USE > 0.0
    return params.USE2 > 0.0 if k == 1 else params.USE3 > 0.0


@law
def better(ekf: Ekf, sensors: Sensors, params: Parameters) -> int:
    """The next compass that is used and heard and shows another field than this one, if this one is heard; -1: none."""
    own, received = field_of(ekf.compass, sensors, params), is_received(ekf.compass, sensors, ekf.now_us)
    for n in range(1, COMPASSES):
        k = (ekf.compass + n) % COMPASSES
        if is_used(k, params.COMPASS) and is_received(k, sensors, ekf.now_us):
            if not received or differs(own, field_of(k, sensors, params)):
                return k
    return -1


@law
def take(ekf: Ekf, log: Events, compass: int, both: bool) -> None:
    """Go on with another compass, whose bias is unknown; ``both``: there is one filter for two."""
    ekf.compass = compass
    ekf.mag_changed_us = ekf.now_us
    ekf.mag_fused_us = ekf.now_us
    ekf.mag_bias = Vec3(0.0, 0.0, 0.0)
    clear(ekf.P, BM, 3, noise.INITIAL_MAG_BIAS * noise.INITIAL_MAG_BIAS)
    magnetometer.clear_samples(ekf)
    if ekf.yaw_aligned:
        emit(log, ekf.now_us, EKF_COMPASS_CHANGED, float(ekf.imu), float(compass))
        if both:
            emit(log, ekf.now_us, EKF_COMPASS_CHANGED, float(1 - ekf.imu), float(compass))


@law
def watch(ekf: Ekf, log: Events, sensors: Sensors, params: Parameters, armed: bool, both: bool) -> None:
    """Each filter step: leave a compass that fails; go back to the first one on the ground when both show the same."""
    if (ekf.yaw_aligned and ekf.now_us - ekf.mag_fused_us > TIMEOUT_US) or not is_used(ekf.compass, params.COMPASS):
        other = better(ekf, sensors, params)
        if other >= 0:
            take(ekf, log, other, both)
    elif ekf.compass != 0 and not armed and is_used(0, params.COMPASS) and is_received(0, sensors, ekf.now_us):
        own, first = field_of(ekf.compass, sensors, params), field_of(0, sensors, params)
        if ekf.now_us - ekf.mag_changed_us > TIMEOUT_US and not differs(first, own):
            take(ekf, log, 0, both)
