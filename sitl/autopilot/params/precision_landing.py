# SPDX-License-Identifier: BSD-3-Clause
"""Parameters of precision landing."""

from __future__ import annotations

from .parameter import BITS16, INT8, INT16, ParameterGroup, param


class PrecisionLanding(ParameterGroup):
    """PLND_: a target to land on or to dock at."""

    ENABLED: float = param(0, 0, 1, "", "1: a landing target is looked for", INT8)
    TYPE: float = param(
        0, 0, 4, "", "Sensor: 0 none, 1 LANDING_TARGET messages, 2 simulated beacon without distance, 4 with it", INT8
    )
    YAW_ALIGN: float = param(0, 0, 36000, "cdeg", "How far the sensor is turned about the vehicle's axis, clockwise")
    LAND_OFS_X: float = param(0, -2000, 2000, "cm", "The vehicle lands so far ahead of the target")
    LAND_OFS_Y: float = param(0, -2000, 2000, "cm", "So far to its right")
    EST_TYPE: float = param(1, 0, 1, "", "0: each measurement counts as it is; 1: a Kalman filter", INT8)
    ACC_P_NSE: float = param(2.5, 0.5, 5.0, "m/s/s", "Noise of the acceleration, as the Kalman filter has it")
    CAM_POS_X: float = param(0, -5.0, 5.0, "m", "Position of the sensor on the vehicle, forward")
    CAM_POS_Y: float = param(0, -5.0, 5.0, "m", "Position of the sensor on the vehicle, right")
    CAM_POS_Z: float = param(0, -5.0, 5.0, "m", "Position of the sensor on the vehicle, down")
    LAG: float = param(0.02, 0.0, 0.25, "s", "Age of a measurement when it arrives")
    XY_DIST_MAX: float = param(2.5, 0.0, 10.0, "m", "No descent while the target is further aside; 0: no limit")
    STRICT: float = param(
        1, 0, 2, "", "Without a target: 0 lands; 1 tries again, then lands; 2 tries again, then hovers", INT8
    )
    RET_MAX: float = param(4, 0, 10, "", "Most tries again in a landing", INT8)
    TIMEOUT: float = param(4.0, 0.0, 20.0, "s", "The descent goes on for so long after the target was lost")
    RET_BEHAVE: float = param(0, 0, 1, "", "Tries again above: 0 where the vehicle last saw the target, 1 it", INT8)
    ALT_MIN: float = param(0.75, 0.0, 5.0, "m", "The sensor sees a target from this height on; see ALT_MAX")
    ALT_MAX: float = param(
        8.0, 0.0, 50.0, "m", "And up to this one, by range-finder; elsewhere there is no second try; both 0: everywhere"
    )
    OPTIONS: float = param(
        0, *BITS16, "",
        "Bits: 1 the target moves, 2 goes on after sticks moved the vehicle, 4 no slow end of the descent", INT16,
    )  # fmt: skip
