# SPDX-License-Identifier: BSD-3-Clause
"""What inertial sensors and compasses show, corrected by their calibration: INS_, COMPASS_, AHRS_TRIM."""

from __future__ import annotations

from ..core.algebra import by_component, quat_from_euler, rotate
from ..core.border import Sensors
from ..core.kernels import law
from ..core.records import Record
from ..core.vectors import Euler, Vec3
from .params.parameters import Parameters
from .params.simulation import DELIVERED, Axes, axes
from .params.system import Ahrs, Compass

COMPASS_RUNNING, COMPASS_DONE, ACCELS_DONE = 1, 2, 4
"""``Calibrated.state``: compasses are being calibrated, or have been, or accelerometers have, since power-on."""


class Calibrated(Record):
    """What sensors show, corrected, and where their calibration stands."""

    acc: Vec3  # specific force, body [m/s^2]
    gyro: Vec3  # body rates [rad/s]
    mag: Vec3  # field of the first compass, body [gauss]
    mag_seen: int  # ``sensors.mag_count`` of it
    state: int  # COMPASS_RUNNING, ... (written by the shell)


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
def first_field(sensors: Sensors, compass: Compass) -> Vec3:
    """The field of the first compass; the offsets at delivery are in what it shows already."""
    return corrected_field(sensors.mag, axes(compass.OFS) - DELIVERED, compass.DIA, compass.ODI)


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
    if sensors.mag_count != c.mag_seen:
        c.mag_seen = sensors.mag_count
        c.mag = mounted(first_field(sensors, params.COMPASS), params.AHRS)
