# SPDX-License-Identifier: BSD-3-Clause
"""The last few inertial samples at 25 Hz, for on-board logs.

A log wants them more often than anything else. The core keeps them, so that the shell need not stop it for each.
"""

from __future__ import annotations

from ..core.algebra import euler_of, set_row_vector
from ..core.kernels import inlined
from ..core.records import Floats, Ints, Record, array
from ..core.vectors import Quat, Vec3

INERTIAL_RING = 4
PERIOD_US = 40_000


class InertialRing(Record):
    """The last inertial samples, for on-board logs."""

    count: int  # samples since boot; the last is at (count - 1) % INERTIAL_RING
    due_us: int  # when the next is taken
    time_us: Ints = array(INERTIAL_RING, stored="i8")
    acc: Floats = array(INERTIAL_RING, 3)  # as measured [m/s^2]
    gyro: Floats = array(INERTIAL_RING, 3)  # as measured [rad/s]
    euler: Floats = array(INERTIAL_RING, 3)  # as estimated [rad]


@inlined
def remember(ring: InertialRing, time_us: int, acc: Vec3, gyro: Vec3, q: Quat) -> None:
    """Last thing of a tick: keep a sample when it is time."""
    if time_us < ring.due_us:
        return
    ring.due_us = (time_us // PERIOD_US + 1) * PERIOD_US
    k = ring.count % INERTIAL_RING
    ring.count += 1
    ring.time_us[k] = time_us
    set_row_vector(ring.acc, k, acc)
    set_row_vector(ring.gyro, k, gyro)
    euler = euler_of(q)
    ring.euler[k, 0], ring.euler[k, 1], ring.euler[k, 2] = euler.roll, euler.pitch, euler.yaw
