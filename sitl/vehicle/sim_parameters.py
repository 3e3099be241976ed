# SPDX-License-Identifier: BSD-3-Clause
"""What the SIM_ parameters do to the simulated world: wind and faults, at power-on and in flight."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from ..autopilot.params.simulation import DELIVERED, Receiver, SecondBarometer, Simulated, axes
from ..core.algebra import ZERO, conjugate, cross, dot, quat_from_euler
from ..core.border import BAROS_DIFFER, ONE_BARO, Sensors
from ..core.constants import TICK_S, TICK_US
from ..core.elementary import pow
from ..core.memory import words_of
from ..core.rng import next_u32
from ..core.vectors import Euler, Vec3
from ..physics.native.records import BARO_RING, BaroFault, GpsReceiver, Iron, SensorState
from ..physics.native.wind import EVEN
from . import imu_faults
from .record import Vehicle

PREFIX = "SIM_"
OTHERS = ("RNGFND1_", "GPS1_TYPE", "GPS2_TYPE")
"""Beginnings of other names of parameters that make sensors."""
DEFAULT_VOLTAGE = float(np.float32(12.6))
"""SIM_BATT_VOLTAGE that leaves the airframe's battery as it is [V]."""
DEFAULT_LAG_MS, DEFAULT_SATELLITES, DEFAULT_BARO_NOISE = 100.0, 10.0, float(np.float32(0.2))
"""Values that leave to the airframe what its receiver and barometer are like."""
FIX_BYTES = 100
"""Of a receiver's message with a fix."""
SINGULAR = 1e-6
"""Determinant below which a matrix of soft iron is none."""
NOISE_SHARE = 0.3
"""Standard deviation of a compass's noise, of SIM_MAG_RND."""
Fault = Callable[[Vehicle], None]
"""Brings the physics or the sensors of a vehicle in line with its parameters."""

_registered: dict[str, Fault] = {}


def register_fault(prefix: str, apply: Fault) -> None:
    """Make a fault of another package known in this process.

    Args:
        prefix: of its parameters (``sitl.autopilot.params.registered``): whenever one is set, ``apply`` is called.
        apply: called at power-on, too.
    """
    _registered[f"{prefix}_"] = apply


def acts_on_the_world(parameter: str) -> bool:
    """Whether a parameter belongs to the simulated world, not to the firmware."""
    return parameter.startswith((PREFIX, *OTHERS, *_registered))


def _bend(iron: Iron, diagonal: Vec3, others: Vec3) -> None:
    """Soft iron that a matrix of this diagonal and these elements xy, xz, yz makes up for."""
    a, b, c = (
        Vec3(diagonal.x, others.x, others.y),
        Vec3(others.x, diagonal.y, others.z),
        Vec3(others.y, others.z, diagonal.z),
    )
    of_a, of_b, of_c = cross(b, c), cross(c, a), cross(a, b)  # rows of the inverse, which is symmetric, too
    determinant = dot(a, of_a)
    iron.is_soft = any(diagonal) and abs(determinant) > SINGULAR
    if iron.is_soft:
        iron.x, iron.y, iron.z = of_a / determinant, of_b / determinant, of_c / determinant


def _look_down(v: Vehicle) -> None:
    """Optical flow and range-finder; a range-finder of the airframe, in a world, is there anyhow (``ranging``)."""
    p, down = v.autopilot.params, v.physics.downward
    has_flow = p.SIM.FLOW_ENABLE != 0
    down.flow_period = max(round(1e6 / (p.SIM.FLOW_RATE * TICK_US)), 1) if has_flow else 0
    down.flow_delay = round(p.SIM.FLOW_DELAY * 1e3 / TICK_US)
    down.flow_noise = p.SIM.FLOW_RND
    down.ranges = p.RNGFND1.TYPE != 0 and not down.in_world
    down.range_min, down.range_max = p.RNGFND1.MIN, p.RNGFND1.MAX
    down.present = has_flow or down.ranges


def _spoil_gps(receiver: GpsReceiver, gps: Receiver, is_looked_for: bool) -> None:
    receiver.present = is_looked_for
    receiver.off = gps.ENABLE == 0 or gps.TYPE == 0 or not is_looked_for
    receiver.jammed = gps.JAM != 0
    fault = receiver.fault
    fault.delay = -1 if gps.LAG_MS == DEFAULT_LAG_MS else round(1e-3 * gps.LAG_MS / TICK_S)
    fault.satellites = -1 if gps.NUMSATS == DEFAULT_SATELLITES else int(gps.NUMSATS)
    fault.lat, fault.lon = round(1e7 * gps.GLTCH.X), round(1e7 * gps.GLTCH.Y)
    fault.alt, fault.noise, fault.drift = gps.GLTCH.Z + gps.ALT_OFS, gps.NOISE, gps.DRFTALT
    fault.vel = axes(gps.VERR)
    fault.loss = 1.0 - pow(1.0 - 0.01 * gps.BYTELOS, float(FIX_BYTES))
    fault.is_on = fault.delay >= 0 or fault.satellites >= 0 or any(
        (fault.lat, fault.lon, fault.alt, fault.noise, fault.drift, *fault.vel, fault.loss)
    )  # fmt: skip


def _spoil_barometer(fault: BaroFault, baro: SecondBarometer, period: int) -> None:
    fault.off, fault.frozen = baro.DISABLE != 0, baro.FREEZE != 0
    fault.height, fault.drift = baro.GLITCH, baro.DRIFT
    fault.noise = 0.0 if baro.RND == DEFAULT_BARO_NOISE else baro.RND
    fault.delay = min(round(1e-3 * baro.DELAY / (period * TICK_S)), BARO_RING - 1) if period else 0
    wcf = baro.WCF
    fault.front, fault.back = Vec3(wcf.FWD, wcf.RGT, wcf.DN), Vec3(wcf.BAK, wcf.LFT, wcf.UP)
    fault.is_on = fault.frozen or any(
        (fault.height, fault.drift, fault.drifted, fault.noise, fault.delay, *fault.front, *fault.back)
    )
    if not fault.is_on:
        fault.taken = 0


def _kind(fault: BaroFault) -> tuple[object, ...]:
    """What is wrong with a barometer."""
    return (
        fault.off, fault.frozen, fault.height, fault.drift, fault.drifted, fault.noise, fault.delay, fault.front,
        fault.back,
    )  # fmt: skip


def _spoil_barometers(s: SensorState, shown: Sensors, sim: Simulated, period: int) -> None:
    """Both of them; a second one that has the same faults shows what the first does."""
    first, second = s.baros[0], s.baros[1]
    if not s.baros_differ:
        words_of(second)[:] = words_of(first)
        shown.abs_pressure2 = shown.abs_pressure
    _spoil_barometer(first, sim.BARO, period)
    _spoil_barometer(second, sim.BAR2, period)
    has_second = sim.BARO.COUNT >= 2
    s.baros_differ = has_second and _kind(first) != _kind(second)
    shown.baro_state = BAROS_DIFFER if s.baros_differ else 0 if has_second else ONE_BARO


def apply(v: Vehicle) -> None:
    """Bring what every kind of vehicle has in line with its SIM_ parameters, and with those of other packages."""
    sim, physics, sensors, wind = v.autopilot.params.SIM, v.physics, v.physics.sensors, v.physics.wind
    wind.speed, wind.direction = sim.WIND_SPD, sim.WIND_DIR
    wind.turbulence, wind.time_constant = sim.WIND_TURB, sim.WIND_TC
    wind.profile, wind.full_height, wind.gain = int(sim.WIND_T), sim.WIND_T_ALT, sim.WIND_T_COEF
    wind.elevation = sim.WIND_DIR_Z
    wind.is_shaped = wind.profile != EVEN or wind.elevation != 0.0
    _spoil_gps(sensors.gps[0], sim.GPS1, v.autopilot.params.GPS1_TYPE != 0)
    _spoil_gps(sensors.gps[1], sim.GPS2, v.autopilot.params.GPS2_TYPE != 0)
    _spoil_barometers(sensors, v.sensors, sim, physics.derived.baro_period)
    ranges = sensors.range_fault
    ranges.glitch, ranges.noise, ranges.loss = sim.SONAR_GLITCH, sim.SONAR_RND, sim.SONAR_LOSS
    ranges.lidar_loss = sim.LIDAR_LOSS
    ranges.is_on = any((ranges.glitch, ranges.noise, ranges.loss, ranges.lidar_loss))
    imu_faults.apply(sim, sensors, v.sensors)
    trim = sim.ACC_TRIM
    sensors.acc_is_turned = any(axes(trim))
    sensors.acc_mount = conjugate(quat_from_euler(Euler(trim.X, trim.Y, trim.Z)))
    sensors.compass_by_current = 1e-3 * axes(sim.MAG_MOT)
    sensors.compass_noise = 1e-3 * NOISE_SHARE * sim.MAG_RND
    sensors.is_disturbed = sim.MAG_RND > 0 or any(axes(sim.MAG_MOT))
    sensors.compass_silent = 0
    for k, compass in enumerate((sim.MAG1, sim.MAG2, sim.MAG3)):
        sensors.compass_silent |= (compass.FAIL != 0) << k
        iron, corrected = sensors.irons[k], ZERO if k else DELIVERED
        iron.gain_error = compass.SCALING - 1.0
        iron.hard = 1e-3 * (axes(compass.OFS) - corrected)
        _bend(iron, axes(compass.DIA), axes(compass.ODI))
    physics.battery.full_voltage = 0.0 if sim.BATT_VOLTAGE == DEFAULT_VOLTAGE else sim.BATT_VOLTAGE
    physics.battery.capacity, physics.battery.resistance = sim.BATT_CAP_AH, sim.BATT_RES
    if v.tick == 0 and sim.BARO.COUNT < 1:
        sensors.baro_missing = True
        v.sensors.baro_count = 0
    rc = v.autopilot.rc
    rc.has_receiver, rc.is_neutral = sim.RC_FAIL != 1, sim.RC_FAIL == 2
    rc.stuck, rc.noise = int(sim.RC_STUCK), sim.RC_NOISE
    rc.is_faulty = rc.is_neutral or rc.stuck != 0 or rc.noise > 0.0
    if rc.noise > 0.0 and rc.noise_state == 0:
        rc.noise_state = next_u32(v.rng) >> 1
    _look_down(v)
    for fault in _registered.values():
        fault(v)
