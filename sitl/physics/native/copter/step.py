# SPDX-License-Identifier: BSD-3-Clause
"""One tick of a multicopter's world: wind, rotors, body, ground, solids, battery, sensors."""

from __future__ import annotations

from ....core.algebra import ZERO, rotate, rotate_inverse
from ....core.constants import GRAVITY, TICK_US
from ....core.kernels import inline_unit, law
from ....core.records import Records
from ....core.vectors import Vec3
from .. import battery, bench, obstacles, wind
from ..body import Inertia, Wrench, fly
from ..records import GROUND_AIRBORNE, GROUND_STANDING, Vehicle
from ..sensors.imu_faults import MOTORS_TURN
from ..sensors.sense import sense
from ..tick import Clock
from . import esc, rotors, vibration
from .ground import absorb, lifts_off, rest, touch
from .state import Physics
from .wrench import act


@law
def begin(v: Vehicle[Physics]) -> None:
    """First thing of a tick: the clock goes on, wind blows, actuator controls become rotor commands."""
    v.time_us += TICK_US
    v.tick += 1
    p = v.physics
    if v.tick % wind.PERIOD_TICKS == 0:
        wind.blow(p.wind, v.rng, -p.body.pos.z)
    if v.time_us > p.shove.until_us:
        p.shove.until_us = 0
    if v.time_us > p.shove.twist_until_us:
        p.shove.twist_until_us = 0
    rotors.command(p.rotors, v.actuators.controls, p.airframe, p.derived)


@law
def substep(p: Physics, wrench: Wrench, time_us: int) -> Vec3:
    """Advance the body by a substep; returns its specific force [m/s^2], body frame."""
    body, ground, airframe, inverse_mass, dt = p.body, p.ground, p.airframe, p.derived.inverse_mass, p.derived.dt
    acc = inverse_mass * wrench.force
    stands = ground.state == GROUND_STANDING
    if stands and lifts_off(body.q, wrench.force, inverse_mass):
        ground.state = GROUND_AIRBORNE
    if ground.state != GROUND_AIRBORNE:
        return rest(body, acc, stands, p.downward.ground_d, airframe, dt)
    fly(body, wrench, Inertia(airframe.inertia, p.derived.inverse_inertia, inverse_mass), dt)
    touch(body, ground, p.downward.ground_d, airframe, time_us)
    return acc


@law
def move(p: Physics, time_us: int) -> None:
    """Advance the body by one tick; sets its means over the tick."""
    body, substeps = p.body, p.airframe.substeps
    body.rates_mean = ZERO
    force = ZERO
    for _ in range(substeps):
        force += substep(p, act(p), time_us)
    k = 1.0 / substeps
    body.rates_mean *= k
    force *= k
    if p.ground.impulse != 0.0:
        force += rotate_inverse(body.q, Vec3(0.0, 0.0, -absorb(p.ground, p.derived.leg_release)))
    body.specific_force = force
    acc = rotate(body.q, force)
    body.acc_ned = Vec3(acc.x, acc.y, acc.z + GRAVITY)


@law
def end(v: Vehicle[Physics]) -> None:
    """Last thing of a tick: battery and sensors."""
    p = v.physics
    battery.discharge(p.battery, p.rotors.power, p.airframe, p.derived.charge_per_amp)
    sense(p, v.sensors, v.rng, Clock(v.tick, v.time_us))
    if p.rotors.shakes and p.battery.current > p.airframe.avionics_current + MOTORS_TURN:
        vibration.shake(p.rotors, v.sensors, p.airframe)
    if v.tick % esc.PERIOD_TICKS == 0:
        esc.sample(p.rotors, v.sensors, p.airframe, v.actuators.armed, v.time_us)


@inline_unit
def step(fleet: Records[Vehicle[Physics]], i: int) -> None:
    """Advance vehicle ``i`` by one tick of 2500 us: actuators in, sensors out."""
    v = fleet[i]
    begin(v)
    p = v.physics
    if p.airframe.on_bench:
        bench.turn(p.body, v.actuators.pwm, v.time_us)
    else:
        move(p, v.time_us)
    if p.obstacles.present:
        obstacles.collide(p.obstacles, p.body, p.airframe, v.time_us)
        obstacles.show(p.obstacles, p.body)
    end(v)
