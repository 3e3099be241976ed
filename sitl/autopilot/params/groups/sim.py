# SPDX-License-Identifier: BSD-3-Clause
"""SIM_*: the simulated world, under the names of ArduPilot's SITL. The firmware itself does not read them."""

from __future__ import annotations

from ..parameter import INT8, Parameter

PARAMETERS = (
    Parameter("SIM_WIND_SPD", 0, 0, 50, "m/s", "Speed of the steady wind"),
    Parameter("SIM_WIND_DIR", 180, 0, 360, "deg", "Where the wind comes from"),
    Parameter("SIM_WIND_TURB", 0, 0, 20, "m/s", "Turbulence, standard deviation of each axis"),
    Parameter("SIM_WIND_TC", 5, 0.1, 300, "s", "Correlation time of the turbulence and lag of wind changes"),
    Parameter("SIM_GPS1_ENABLE", 1, 0, 1, "", "0 switches the GPS receiver off", INT8),
    Parameter("SIM_RC_FAIL", 0, 0, 1, "", "1 switches the pilot's transmitter off", INT8),
)
