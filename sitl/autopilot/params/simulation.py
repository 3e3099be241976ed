# SPDX-License-Identifier: BSD-3-Clause
"""Parameters of the simulated surroundings."""

from __future__ import annotations

from .parameter import INT8, ParameterGroup, param


class Simulated(ParameterGroup):
    """SIM_: wind, and what fails."""

    WIND_SPD: float = param(0, 0, 50, "m/s", "Speed of the steady wind")
    WIND_DIR: float = param(180, 0, 360, "deg", "Where the wind comes from")
    WIND_TURB: float = param(0, 0, 20, "m/s", "Turbulence, standard deviation of each axis")
    WIND_TC: float = param(5, 0.1, 300, "s", "Correlation time of the turbulence and lag of wind changes")
    GPS1_ENABLE: float = param(1, 0, 1, "", "0 switches the GPS receiver off", INT8)
    SPEEDUP: float = param(
        1, -1, 100000, "", "Simulated seconds a second; 0 or less: as fast as it goes (drop-in executables only)"
    )
    RC_FAIL: float = param(0, 0, 1, "", "1 switches the pilot's transmitter off", INT8)
