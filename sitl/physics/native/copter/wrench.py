# SPDX-License-Identifier: BSD-3-Clause
"""What acts on a multicopter in the air: its rotors and aerodynamic drag."""

from __future__ import annotations

from ....core.kernels import law
from ....core.rotations import quat_rotate_inverse
from ....vehicles.figures.copter import THRUST_MOMENTUM
from .rotors import lag, momentum_wrench, speed_squared_wrench


@law
def wrench(p):
    """(fx, fy, fz, mx, my, mz) [N, N m], body frame, but gravity and ground; rotors move on by a substep."""
    a, b = p.airframe, p.body
    spin_up = lag(p)
    wind = p.wind.vel
    vx, vy, vz = quat_rotate_inverse(
        float(b.q[0]),
        float(b.q[1]),
        float(b.q[2]),
        float(b.q[3]),
        float(b.vel[0]) - float(wind[0]),
        float(b.vel[1]) - float(wind[1]),
        float(b.vel[2]) - float(wind[2]),
    )
    roll_rate, pitch_rate, yaw_rate = float(b.rates[0]), float(b.rates[1]), float(b.rates[2])
    if int(a.thrust_model) == THRUST_MOMENTUM:
        fx, fy, fz, mx, my, mz = momentum_wrench(p, vx, vy, vz, roll_rate, pitch_rate, yaw_rate)
    else:
        fx, fy, fz, mx, my, mz = speed_squared_wrench(p, vx, vy, roll_rate, pitch_rate, yaw_rate)
    half = 0.5 * float(p.air.density)
    fx -= half * a.drag_area.x * vx * abs(vx)
    fy -= half * a.drag_area.y * vy * abs(vy)
    fz -= half * a.drag_area.z * vz * abs(vz)
    damping = float(a.angular_damping)
    mx -= damping * a.inertia.x * roll_rate
    my -= damping * a.inertia.y * pitch_rate
    mz += spin_up - damping * a.inertia.z * yaw_rate
    return (fx, fy, fz, mx, my, mz)
