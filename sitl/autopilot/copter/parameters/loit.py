# SPDX-License-Identifier: BSD-3-Clause
"""LOITER."""

from __future__ import annotations

from ...params.parameter import Parameter

PARAMETERS = (
    Parameter(
        "LOIT_ANG_MAX",
        0.0,
        0.0,
        45.0,
        "deg",
        "Greatest lean of the sticks; 0 is two thirds of PSC_ANGLE_MAX or ANGLE_MAX",
    ),
    Parameter("LOIT_SPEED", 1250.0, 20.0, 3500.0, "cm/s", "Greatest speed"),
    Parameter("LOIT_ACC_MAX", 500.0, 100.0, 981.0, "cm/s/s", "Greatest acceleration of the position correction"),
    Parameter("LOIT_BRK_ACCEL", 250.0, 25.0, 2500.0, "cm/s/s", "Greatest deceleration with sticks centred"),
    Parameter("LOIT_BRK_JERK", 500.0, 50.0, 10000.0, "cm/s/s/s", "Jerk of the braking"),
    Parameter("LOIT_BRK_DELAY", 1.0, 0.0, 10.0, "s", "From centring the sticks to braking"),
)
