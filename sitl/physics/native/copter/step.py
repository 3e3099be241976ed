# SPDX-License-Identifier: BSD-3-Clause
"""One tick of a multicopter's world: wind, rotors, body, ground, solids, battery, sensors."""

from __future__ import annotations

from ....core.kernels import law, unit
from ....core.rotations import quat_rotate, quat_rotate_inverse
from .. import battery, obstacles, wind
from ..body import GRAVITY, fly
from ..sensors.sense import sense
from ..tick import TICK_S, TICK_US
from . import rotors
from .ground import absorb, leaves, rest, touch
from .state import GROUND_AIRBORNE, GROUND_STANDING
from .wrench import wrench


@law
def begin(v):
    """First thing of a tick: the clock goes on, wind blows, actuator controls become rotor commands."""
    v.time_us += TICK_US
    v.tick += 1
    p = v.physics
    if int(v.tick) % wind.PERIOD_TICKS == 0:
        wind.update(p.wind, v.rng)
    rotors.command(p, v.actuators.controls)


@law
def move(p, time_us):
    """Advance the body by one tick; sets its means over the tick."""
    b = p.body
    b.rates_mean[0], b.rates_mean[1], b.rates_mean[2] = 0.0, 0.0, 0.0
    sx, sy, sz = 0.0, 0.0, 0.0
    n = int(p.airframe.substeps)
    for _ in range(n):
        fx, fy, fz, mx, my, mz = wrench(p)
        standing = p.ground.state == GROUND_STANDING
        if p.ground.state == GROUND_AIRBORNE or (standing and leaves(p, fx, fy, fz)):
            fly(p, fx, fy, fz, mx, my, mz)
            touch(p, time_us)
            k = float(p.derived.inverse_mass)
            ax, ay, az = fx * k, fy * k, fz * k
        else:
            ax, ay, az = rest(p, fx, fy, fz)
        sx += ax
        sy += ay
        sz += az
    k = 1.0 / n
    for j in range(3):
        b.rates_mean[j] *= k
    sx, sy, sz = sx * k, sy * k, sz * k
    q = b.q
    w, x, y, z = float(q[0]), float(q[1]), float(q[2]), float(q[3])
    if p.ground.impulse != 0.0:
        ax, ay, az = quat_rotate_inverse(w, x, y, z, 0.0, 0.0, -absorb(p, TICK_S))
        sx, sy, sz = sx + ax, sy + ay, sz + az
    b.specific_force[0], b.specific_force[1], b.specific_force[2] = sx, sy, sz
    an, ae, ad = quat_rotate(w, x, y, z, sx, sy, sz)
    b.acc_ned[0], b.acc_ned[1], b.acc_ned[2] = an, ae, ad + GRAVITY


@law
def end(v):
    """Last thing of a tick: battery and sensors."""
    battery.update(v.physics, float(v.physics.rotors.power))
    sense(v.physics, v.sensors, int(v.tick), int(v.time_us), v.rng)


@unit
def step(fleet, i):
    """Advance vehicle ``i`` by one tick of 2500 us: actuators in, sensors out."""
    v = fleet[i]
    begin(v)
    p, time_us = v.physics, int(v.time_us)
    move(p, time_us)
    if p.obstacles.present != 0:
        obstacles.collide(p, time_us)
        obstacles.show(p)
    end(v)
