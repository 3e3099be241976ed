# SPDX-License-Identifier: BSD-3-Clause
"""What the SIM_ parameters do to the simulated world: wind and faults, at power-on and in flight."""

from __future__ import annotations

from typing import Any

PREFIX = "SIM_"


def apply(v: Any) -> None:
    """Bring what every kind of vehicle has in line with the SIM_ parameters of ``v``."""
    params, physics, wind = v.autopilot.params, v.physics, v.physics.wind
    wind.speed, wind.direction = params.SIM.WIND_SPD, params.SIM.WIND_DIR
    wind.turbulence, wind.time_constant = params.SIM.WIND_TURB, params.SIM.WIND_TC
    physics.sensors.gps_off = params.SIM.GPS1_ENABLE == 0
    v.autopilot.rc.has_receiver = int(params.SIM.RC_FAIL == 0)
