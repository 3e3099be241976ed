# SPDX-License-Identifier: BSD-3-Clause
"""Measurements that cannot be: the filter then trusts sensors as little as EK3_*_M_NSE says.

The filter works with the noise that sensors really have (noise.py), so that a healthy flight is as exact as can be. A
sensor that fails within ArduPilot's wide gates would then pull the vehicle along at once. Innovations of eight standard
deviations, which no healthy flight sees, put the filter in doubt: noise is what ArduPilot's parameters say, and the
estimate follows as slowly as there.
"""

from __future__ import annotations

from ...core.algebra import rotation_matrix
from ...core.kernels import inlined, law
from ...core.records import Floats
from . import noise
from .covariance import clear
from .fusion import Innovation
from .state import BA, POS, VEL, Ekf

ODD = 64.0
"""Squared innovation by variance that cannot be."""
ALONG_GRAVITY = 0.8
"""Cosine of the angle to gravity within which an axis of the accelerometer is along it."""
PUSHED_SPEED, PUSHED_HEIGHT = 0.2, 0.05
"""Innovations of the receiver's vertical velocity [m/s] and of the barometer [m]: a healthy flight seldom has both."""
HOLD_US = 5_000_000
"""After the last of them the filter stays in doubt so long."""


@inlined
def is_doubting(ekf: Ekf) -> bool:
    """Whether EK3_*_NSE count as they stand."""
    return ekf.doubt_us != 0


@law
def watch(ekf: Ekf) -> None:
    """Each filter step in doubt: end it in time.

    Biases of the accelerometer across gravity are hard to tell from a lie of the receiver: they stay as they are.
    """
    if ekf.now_us - ekf.doubt_us > HOLD_US:
        ekf.doubt_us = 0
    down = rotation_matrix(ekf.q).z
    if abs(down.x) < ALONG_GRAVITY:
        forget(ekf.P, BA)
    if abs(down.y) < ALONG_GRAVITY:
        forget(ekf.P, BA + 1)
    if abs(down.z) < ALONG_GRAVITY:
        forget(ekf.P, BA + 2)


@law
def forget(P: Floats, k: int) -> None:
    """Forget what ties state ``k`` to others: it will not be learnt from this step's measurements."""
    clear(P, k, 1, P[k, k])


@law
def is_pushed(ekf: Ekf) -> bool:
    """Whether barometer and receiver contradict the filter vertically in the same sense: then the accelerometer lies.

    When one of these two lies, it pulls the filter away from the other one, which contradicts in the opposite sense.
    """
    speed, height = ekf.innovation_vel.z, ekf.innovation_pos.z
    return speed * height > 0.0 and abs(speed) > PUSHED_SPEED and abs(height) > PUSHED_HEIGHT


@law
def begin(ekf: Ekf) -> None:
    """Be in doubt from now on, or still; while the IMUs differ or are pushed, it is one of them that lies."""
    if ekf.blames_imu or (ekf.doubt_us == 0 and is_pushed(ekf)):
        return
    if ekf.doubt_us == 0:
        for k in range(3):
            ekf.P[POS + k, POS + k] += noise.DOUBTED_POSITION * noise.DOUBTED_POSITION
            ekf.P[VEL + k, VEL + k] += noise.DOUBTED_VELOCITY * noise.DOUBTED_VELOCITY
            forget(ekf.P, BA + k)
    ekf.doubt_us = ekf.now_us


@law
def is_odd(ekf: Ekf, innovation: Innovation, variance: float) -> bool:
    """Whether a measurement cannot be; ``variance``: of a healthy sensor.

    In doubt, the variance of the innovation is larger than of a healthy filter: the sensor's counts alone.
    """
    expected = variance if is_doubting(ekf) else innovation.variance
    return innovation.value * innovation.value > ODD * expected
