# SPDX-License-Identifier: BSD-3-Clause
"""Parameters of the estimator."""

from __future__ import annotations

from ...core.records import Records
from .parameter import INT8, INT16, INT32, ParameterGroup, numbered, param
from .without_gps import Sources

_GATE = "innovation gate, hundredths of a standard deviation"


class Ekf3(ParameterGroup):
    """EK3_: the extended Kalman filter. What its noise values mean here is described in ``estimation/noise.py``."""

    ENABLE: float = param(1, 0, 1, "", "start the filter at boot", INT8)
    VELNE_M_NSE: float = param(0.3, 0.01, 100, "m/s", "GPS horizontal velocity noise")
    VELD_M_NSE: float = param(0.5, 0.01, 100, "m/s", "GPS vertical velocity noise")
    VEL_I_GATE: float = param(500, 100, 32767, "", f"GPS velocity {_GATE}", INT16)
    POSNE_M_NSE: float = param(0.5, 0.01, 100, "m", "GPS horizontal position noise")
    POS_I_GATE: float = param(500, 100, 32767, "", f"GPS position {_GATE}", INT16)
    ALT_M_NSE: float = param(2.0, 0.01, 1000, "m", "barometer height noise")
    HGT_I_GATE: float = param(500, 100, 32767, "", f"height {_GATE}", INT16)
    MAG_M_NSE: float = param(0.05, 0.001, 5, "gauss", "magnetometer noise")
    MAG_CAL: float = param(3, 0, 6, "", "magnetometer biases are learnt: 4 always, 2 never, else in the air", INT8)
    YAW_M_NSE: float = param(0.5, 0.001, 10, "rad", "error of the magnetometer's yaw besides its noise")
    YAW_I_GATE: float = param(300, 100, 32767, "", f"yaw {_GATE}", INT16)
    GYRO_P_NSE: float = param(0.015, 0.0001, 1, "rad/s", "gyro noise")
    ACC_P_NSE: float = param(0.35, 0.01, 10, "m/s/s", "accelerometer noise")
    GBIAS_P_NSE: float = param(0.001, 0, 1, "rad/s/s", "how fast gyro biases wander")
    ABIAS_P_NSE: float = param(0.02, 0, 10, "m/s/s/s", "how fast accelerometer biases wander")
    MAGB_P_NSE: float = param(0.0001, 0, 1, "gauss/s", "how fast magnetometer biases wander")
    ACC_BIAS_LIM: float = param(1.0, 0.1, 10, "m/s/s", "largest accelerometer bias that is learnt")
    GPS_CHECK: float = param(31, 0, 255, "", "GPS checks before use: bit 0 satellites, bit 1 HDOP", INT8)
    CHECK_SCALE: float = param(100, 10, 1000, "%", "scale of the limits of the GPS checks", INT16)
    NOAID_M_NSE: float = param(10.0, 0.5, 1000, "m", "noise of the position held in flight without GPS")
    ERR_THRESH: float = param(0.2, 0.05, 1, "", "difference of two filters' scores from which on it counts")
    AFFINITY: float = param(0, 0, 15, "", "bit 2: a filter is also judged by its compass", INT32)
    GSF_RUN_MASK: float = param(3, 0, 3, "", "Bits of the filters for which a bank of yaw filters is there", INT8)
    GSF_USE_MASK: float = param(3, 0, 3, "", "Bits of the filters that take its yaw when theirs is wrong", INT8)
    GSF_RST_MAX: float = param(2, 1, 10, "", "So often at most from arming on", INT8)
    TAU_OUTPUT: float = param(25, 1, 127, "cs", "time in which corrections reach the controllers", INT8)
    MAX_FLOW: float = param(2.5, 1.0, 4.0, "rad/s", "Greatest flow that is used; it limits speeds, too")
    FLOW_M_NSE: float = param(0.25, 0.05, 1.0, "rad/s", "optical flow noise")
    FLOW_I_GATE: float = param(300, 100, 32767, "", f"optical flow {_GATE}", INT16)
    FLOW_DELAY: float = param(10, 0, 127, "ms", "age of an optical flow when it arrives", INT8)
    SRC: Records[Sources] = numbered(Sources, 3, POSXY=(3, 0, 0), VELXY=(3, 0, 0), VELZ=(3, 0, 0), YAW=(1, 0, 0))
