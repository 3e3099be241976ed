# SPDX-License-Identifier: BSD-3-Clause
"""Battery monitor and failsafe."""

from __future__ import annotations

from ..parameter import INT8, INT32, Parameter

PARAMETERS = (
    Parameter("BATT_MONITOR", 0, 0, 4, "", "0 none, 3 voltage, 4 voltage and current", INT8),
    Parameter("BATT_CAPACITY", 3300, 0, 2000000, "mAh", "Charge of the full battery", INT32),
    Parameter("BATT_LOW_TIMER", 10, 0, 120, "s", "Voltage is low only when low for so long", INT8),
    Parameter("BATT_LOW_VOLT", 10.5, 0.0, 120.0, "V", "Low; 0 off"),
    Parameter("BATT_LOW_MAH", 0.0, 0.0, 2000000.0, "mAh", "Low when less is left; 0 off"),
    Parameter("BATT_CRT_VOLT", 0.0, 0.0, 120.0, "V", "Critical; 0 off"),
    Parameter("BATT_CRT_MAH", 0.0, 0.0, 2000000.0, "mAh", "Critical when less is left; 0 off"),
    Parameter("BATT_ARM_VOLT", 0.0, 0.0, 120.0, "V", "Least voltage for arming; 0 off"),
    Parameter("BATT_ARM_MAH", 0, 0, 2000000, "mAh", "Least charge left for arming; 0 off", INT32),
)
