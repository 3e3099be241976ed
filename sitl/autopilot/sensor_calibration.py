# SPDX-License-Identifier: BSD-3-Clause
"""What inertial sensors and compasses show, corrected by their calibration: INS_, COMPASS_, AHRS_TRIM."""

from __future__ import annotations

from ..core.algebra import by_component, dot, dot2, horizontal, norm, norm2, quat_from_euler, rotate
from ..core.border import IMUS_DIFFER, Sensors
from ..core.kernels import law
from ..core.records import Record
from ..core.vectors import Euler, Vec3
from .params.firmware_parameters import Parameters
from .params.simulation import DELIVERED, Axes, axes
from .params.system import Ahrs, Compass

COMPASS_RUNNING, COMPASS_DONE, ACCELS_DONE = 1, 2, 4
"""``Calibrated.state``: compasses are being calibrated, or have been, or accelerometers have, since power-on."""
PARAMETERS_BAD, SWITCHES_BAD, NEEDS_LOCATION = 8, 16, 32
"""The same of parameters (``parameter_checks``): some forbid arming, some while there is a receiver, or a vehicle
without a position may not be armed in any mode (ARMING_NEED_LOC)."""

COMPASSES = 3
SILENCE_US = 500_000
"""A compass is healthy while its last sample is no older."""
COMPASS_COS, COMPASS_FLAT_COS = 0.0, 0.5
"""Of the greatest angles between two compasses' fields: 90 degrees in space, 60 in the x-y plane."""
COMPASS_FLAT_DIFFERENCE = 0.2
"""Greatest difference of their x-y components [gauss]."""


class Calibrated(Record):
    """What sensors show, corrected, and where their calibration stands."""

    acc: Vec3  # specific force, body [m/s^2]
    gyro: Vec3  # body rates [rad/s]
    acc2: Vec3  # of the second IMU, while the IMUs differ
    gyro2: Vec3
    mag: Vec3  # field of the first compass, body [gauss]
    mag_seen: int  # ``sensors.mag_count`` of it
    state: int  # what forbids arming: COMPASS_RUNNING, ... (written by the shell)


@law
def corrected_field(shown: Vec3, offset: Vec3, diagonal: Axes, others: Axes) -> Vec3:
    """Field [gauss] of a compass that needs an offset [mGauss] and a symmetric matrix against soft iron."""
    raw = shown + 1e-3 * offset
    return Vec3(
        diagonal.X * raw.x + others.X * raw.y + others.Y * raw.z,
        others.X * raw.x + diagonal.Y * raw.y + others.Z * raw.z,
        others.Y * raw.x + others.Z * raw.y + diagonal.Z * raw.z,
    )


@law
def shown_field(k: int, sensors: Sensors, params: Compass) -> Vec3:
    """The field of compass ``k``; the offsets at delivery are in what the first one shows already."""
    if k == 0:
        return corrected_field(sensors.mag, axes(params.OFS) - DELIVERED, params.DIA, params.ODI)
    if k == 1:
        return corrected_field(sensors.mag2, axes(params.OFS2), params.DIA2, params.ODI2)
    return corrected_field(sensors.mag3, axes(params.OFS3), params.DIA3, params.ODI3)


@law
def field_of(k: int, sensors: Sensors, params: Parameters) -> Vec3:
    """The field of compass ``k`` in the vehicle's axes."""
    return mounted(shown_field(k, sensors, params.COMPASS), params.AHRS)


@law
def is_received(k: int, sensors: Sensors, now_us: int) -> bool:
    """Whether compass ``k`` sends samples."""
    if k == 0 and sensors.mag_us[0] == 0:
        return sensors.mag_count > 0  # behind a link that does not say when
    return sensors.mag_us[k] > 0 and now_us - sensors.mag_us[k] <= SILENCE_US


@law
def differs(field: Vec3, other: Vec3) -> bool:
    """Whether a compass shows another field than the first: by angle in space, by angle or length in the x-y plane."""
    size = norm(field) * norm(other)
    flat, other_flat = horizontal(field), horizontal(other)
    flat_size = norm2(flat) * norm2(other_flat)
    if flat_size <= 0.0:
        return True
    if dot(field, other) < size * COMPASS_COS or dot2(flat, other_flat) < flat_size * COMPASS_FLAT_COS:
        return True
    return norm2(flat - other_flat) > COMPASS_FLAT_DIFFERENCE


@law
def corrected_acc(shown: Vec3, params: Parameters) -> Vec3:
    """Specific force [m/s^2] in the autopilot's axes."""
    return by_component(shown - axes(params.INS.ACCOFFS), axes(params.INS.ACCSCAL))


@law
def mounted(vector: Vec3, params: Ahrs) -> Vec3:
    """A vector in the vehicle's axes, from the autopilot's."""
    trim = params.TRIM
    if trim.X == 0.0 and trim.Y == 0.0:
        return vector
    return rotate(quat_from_euler(Euler(trim.X, trim.Y, 0.0)), vector)


@law
def read_sensors(c: Calibrated, sensors: Sensors, params: Parameters) -> None:
    """First thing of a tick: correct the new samples."""
    c.acc = mounted(corrected_acc(sensors.acc, params), params.AHRS)
    c.gyro = mounted(sensors.gyro - axes(params.INS.GYROFFS), params.AHRS)
    if sensors.imu_state & IMUS_DIFFER != 0:
        c.acc2 = mounted(corrected_acc(sensors.acc2, params), params.AHRS)
        c.gyro2 = mounted(sensors.gyro2 - axes(params.INS.GYROFFS), params.AHRS)
    if sensors.mag_count != c.mag_seen:
        c.mag_seen = sensors.mag_count
        c.mag = field_of(0, sensors, params)
