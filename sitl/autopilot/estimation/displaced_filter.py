# SPDX-License-Identifier: BSD-3-Clause
"""The filter is put elsewhere with its vehicle: its errors turn along, biases stay those of the body."""

from __future__ import annotations

from ...core.displacement import (
    Displacement,
    faster,
    move_past,
    moved,
    moved_ne,
    on_the_ground,
    turned,
    turned_attitude,
)
from ...core.kernels import law
from ...core.records import Floats
from ..state import Estimate
from .covariance import turn_frame
from .state import RING, Ekf


@law
def _move_errors(errors: Floats, d: Displacement) -> None:
    """Errors of attitude, velocity and position found and not yet put into the state."""
    for n in range(0, 9, 3):
        a, b = float(errors[n]), float(errors[n + 1])
        errors[n], errors[n + 1] = d.cosine * a - d.sine * b, d.sine * a + d.cosine * b


@law
def _move_history(ekf: Ekf, d: Displacement) -> None:
    for n in range(RING):
        move_past(d, ekf.ring_pos, n, 1e-6 * (ekf.now_us - ekf.ring_us[n]))
        a, b = float(ekf.ring_vel[n, 0]), float(ekf.ring_vel[n, 1])
        ekf.ring_vel[n, 0] = d.cosine * a - d.sine * b + d.velocity.x
        ekf.ring_vel[n, 1] = d.sine * a + d.cosine * b + d.velocity.y
        ekf.ring_vel[n, 2] += d.velocity.z


@law
def _move_samples(ekf: Ekf, d: Displacement) -> None:
    """Means under way: heights, and the field turned to NED, of which only the error turns."""
    ages = 1e-6 * (ekf.baro_n * ekf.now_us - ekf.baro_us_sum)
    ekf.baro_sum += ages * d.velocity.z - ekf.baro_n * d.shift.z
    field = float(ekf.mag_n) * ekf.earth_field
    ekf.mag_sum = field + turned(d, ekf.mag_sum - field)


@law
def move_ekf(ekf: Ekf, d: Displacement) -> None:
    """Put the filter elsewhere."""
    ekf.q = turned_attitude(d, ekf.q)
    ekf.vel, ekf.pos = faster(d, ekf.vel), moved(d, ekf.pos)
    turn_frame(ekf.P, d.angle)
    _move_errors(ekf.dx, d)
    ekf.lag_vel, ekf.lag_pos = turned(d, ekf.lag_vel), turned(d, ekf.lag_pos)
    ekf.last_acc_ned, ekf.step_dv = turned(d, ekf.last_acc_ned), turned(d, ekf.step_dv)
    ekf.hold_pos = moved_ne(on_the_ground(d), ekf.hold_pos)
    _move_history(ekf, d)
    _move_samples(ekf, d)


@law
def move_estimate(e: Estimate, d: Displacement) -> None:
    """Put what the filter last said elsewhere; its origin is not touched."""
    e.vel, e.pos, e.acc_ned = faster(d, e.vel), moved(d, e.pos), turned(d, e.acc_ned)
    e.reset_pos, e.reset_vel = turned(d, e.reset_pos), turned(d, e.reset_vel)
    e.q = turned_attitude(d, e.q)
