# SPDX-License-Identifier: BSD-3-Clause
"""Extended Kalman filter. What the noise figures mean to this filter is told in ``estimation/noise.py``."""

from __future__ import annotations

from ..parameter import INT8, INT16, Parameter

_GATE = "innovation gate, hundredths of a standard deviation"

PARAMETERS = (
    Parameter("EK3_ENABLE", 1, 0, 1, "", "start the filter at boot", INT8),
    Parameter("EK3_VELNE_M_NSE", 0.3, 0.01, 100, "m/s", "GPS horizontal velocity noise"),
    Parameter("EK3_VELD_M_NSE", 0.5, 0.01, 100, "m/s", "GPS vertical velocity noise"),
    Parameter("EK3_VEL_I_GATE", 500, 100, 32767, "", f"GPS velocity {_GATE}", INT16),
    Parameter("EK3_POSNE_M_NSE", 0.5, 0.01, 100, "m", "GPS horizontal position noise"),
    Parameter("EK3_POS_I_GATE", 500, 100, 32767, "", f"GPS position {_GATE}", INT16),
    Parameter("EK3_ALT_M_NSE", 2.0, 0.01, 1000, "m", "barometer height noise"),
    Parameter("EK3_HGT_I_GATE", 500, 100, 32767, "", f"height {_GATE}", INT16),
    Parameter("EK3_MAG_M_NSE", 0.05, 0.001, 5, "gauss", "magnetometer noise"),
    Parameter("EK3_YAW_M_NSE", 0.5, 0.001, 10, "rad", "error of the magnetometer's yaw besides its noise"),
    Parameter("EK3_YAW_I_GATE", 300, 100, 32767, "", f"yaw {_GATE}", INT16),
    Parameter("EK3_GYRO_P_NSE", 0.015, 0.0001, 1, "rad/s", "gyro noise"),
    Parameter("EK3_ACC_P_NSE", 0.35, 0.01, 10, "m/s/s", "accelerometer noise"),
    Parameter("EK3_GBIAS_P_NSE", 0.001, 0, 1, "rad/s/s", "how fast gyro biases wander"),
    Parameter("EK3_ABIAS_P_NSE", 0.02, 0, 10, "m/s/s/s", "how fast accelerometer biases wander"),
    Parameter("EK3_MAGB_P_NSE", 0.0001, 0, 1, "gauss/s", "how fast magnetometer biases wander"),
    Parameter("EK3_ACC_BIAS_LIM", 1.0, 0.1, 10, "m/s/s", "largest accelerometer bias that is learnt"),
    Parameter("EK3_GPS_CHECK", 31, 0, 255, "", "GPS checks before use: bit 0 satellites, bit 1 HDOP", INT8),
    Parameter("EK3_CHECK_SCALE", 100, 10, 1000, "%", "scale of the limits of the GPS checks", INT16),
    Parameter("EK3_NOAID_M_NSE", 10.0, 0.5, 1000, "m", "noise of the position held in flight without GPS"),
    Parameter("EK3_TAU_OUTPUT", 25, 1, 127, "cs", "time in which corrections reach the controllers", INT8),
)
