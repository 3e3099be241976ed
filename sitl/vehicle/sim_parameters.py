# SPDX-License-Identifier: BSD-3-Clause
"""What the SIM_ parameters do to the simulated world: wind and faults, at power-on and in flight."""

from __future__ import annotations

from typing import Any

PREFIX = "SIM_"


def apply_to_all(v: Any) -> None:
    """Bring what every kind of vehicle has in line with the SIM_ parameters of ``v``."""
    params, physics, wind = v.autopilot.params, v.physics, v.physics.wind
    wind.speed, wind.direction = params.SIM.WIND_SPD, params.SIM.WIND_DIR
    wind.turbulence, wind.time_constant = params.SIM.WIND_TURB, params.SIM.WIND_TC
    physics.sensors.gps_off = int(params.SIM.GPS1_ENABLE == 0)
    v.autopilot.rc.has_receiver = int(params.SIM.RC_FAIL == 0)


def apply_to_copter(v: Any) -> None:
    """The same, and a copter's failing motors."""
    apply_to_all(v)
    params, rotors = v.autopilot.params, v.physics.rotors
    for k in range(len(rotors.efficiency)):
        fails = int(params.SIM.ENGINE_FAIL) >> k & 1
        rotors.efficiency[k] = params.SIM.ENGINE_MUL if fails else 1.0
