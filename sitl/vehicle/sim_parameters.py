# SPDX-License-Identifier: BSD-3-Clause
"""What the SIM_ parameters do to the simulated world: wind and faults, at power-on and in flight."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from ..autopilot.params.simulation import DELIVERED, axes
from ..core.algebra import ZERO, conjugate, quat_from_euler
from ..core.constants import TICK_US
from ..core.vectors import Euler, Vec3
from ..physics.native.records import Iron
from . import imu_faults
from .record import Vehicle

PREFIX = "SIM_"
OTHERS = ("RNGFND1_", "GPS1_TYPE")
"""Beginnings of other names of parameters that make sensors."""
DEFAULT_VOLTAGE = float(np.float32(12.6))
"""SIM_BATT_VOLTAGE that leaves the airframe's battery as it is [V]."""
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
    matrix = np.array(
        ((diagonal.x, others.x, others.y), (others.x, diagonal.y, others.z), (others.y, others.z, diagonal.z))
    )
    iron.is_soft = any(diagonal) and bool(abs(np.linalg.det(matrix)) > SINGULAR)
    if iron.is_soft:
        x, y, z = np.linalg.inv(matrix).tolist()
        iron.x, iron.y, iron.z = Vec3(*x), Vec3(*y), Vec3(*z)


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


def apply(v: Vehicle) -> None:
    """Bring what every kind of vehicle has in line with its SIM_ parameters, and with those of other packages."""
    sim, physics, sensors, wind = v.autopilot.params.SIM, v.physics, v.physics.sensors, v.physics.wind
    wind.speed, wind.direction = sim.WIND_SPD, sim.WIND_DIR
    wind.turbulence, wind.time_constant = sim.WIND_TURB, sim.WIND_TC
    sensors.gps_off = sim.GPS1_ENABLE == 0 or sim.GPS1_TYPE == 0 or v.autopilot.params.GPS1_TYPE == 0
    sensors.gps_jammed = sim.GPS1_JAM != 0
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
    if v.tick == 0 and sim.BARO_COUNT < 1:
        sensors.baro_missing = True
        v.sensors.baro_count = 0
    v.autopilot.rc.has_receiver = sim.RC_FAIL == 0
    _look_down(v)
    for fault in _registered.values():
        fault(v)
