# SPDX-License-Identifier: BSD-3-Clause
"""What episodes choose from: numbers, faults, and parts that a vehicle can have."""

from __future__ import annotations

import math

NUMBERS = (0.0, 1.0, -1.0, 2.0, 10.0, 400.0, 21196.0, math.nan, math.inf, -math.inf, 3.4e38, -3.4e38, 1e-30, 1e9)
WHOLE = (0, 1, 2, 3, 5, 10, 255, 65535, -1, 2**31 - 1, -(2**31), 900_000_000, -1_800_000_000, -353632621, 1491652371)

FAULTS = {
    "SIM_WIND_SPD": (0.0, 12.0), "SIM_WIND_TURB": (0.0, 3.0), "SIM_GPS1_ENABLE": (0.0, 1.0),
    "SIM_GPS1_JAM": (0.0, 1.0), "SIM_RC_FAIL": (0.0, 1.0), "SIM_ENGINE_FAIL": (0.0, 15.0),
    "SIM_ENGINE_MUL": (0.0, 1.0), "SIM_ACC1_BIAS_Z": (-2.0, 2.0), "SIM_SHOVE_X": (-20.0, 20.0),
    "SIM_SHOVE_TIME": (0.0, 500.0), "SIM_BATT_VOLTAGE": (8.0, 12.6), "SIM_BATT_CAP_AH": (0.0, 1.0),
    "SIM_BATT_RES": (0.0, 1.0), "SIM_TWIST_Z": (-20.0, 20.0), "SIM_TWIST_TIME": (0.0, 500.0),
    "SIM_ENGINE_STUCK": (0.0, 15.0), "SIM_GPS1_GLTCH_X": (-30.0, 30.0), "SIM_GPS1_GLTCH_Y": (-30.0, 30.0),
    "SIM_GPS1_VERR_X": (-10000.0, 10000.0), "SIM_GPS1_LAG_MS": (0.0, 1000.0), "SIM_GPS1_BYTELOS": (0.0, 100.0),
    "SIM_BARO_GLITCH": (-10000.0, 10000.0), "SIM_BARO_DRIFT": (-1000.0, 1000.0), "SIM_BARO_RND": (0.0, 1000.0),
    "SIM_BARO_FREEZE": (0.0, 1.0), "SIM_BARO_DISABLE": (0.0, 1.0), "SIM_BARO_DELAY": (0.0, 1000.0),
    "SIM_BARO_WCF_UP": (-10.0, 10.0), "SIM_WIND_T": (0.0, 2.0), "SIM_WIND_DIR_Z": (-90.0, 90.0),
    "SIM_RC_STUCK": (0.0, 65535.0), "SIM_RC_NOISE": (0.0, 1000.0), "SIM_SONAR_GLITCH": (-1000.0, 1000.0),
    "SIM_LIDAR_LOSS": (0.0, 1.0), "SIM_SONAR_LOSS": (0.0, 1.0), "SIM_GYR1_BIAS_X": (-1.0, 1.0),
    "SIM_GYR2_BIAS_Z": (-1.0, 1.0), "SIM_GYR_FAIL_MSK": (0.0, 3.0), "SIM_ACC_FAIL_MSK": (0.0, 3.0),
    "SIM_ACCEL1_FAIL": (-20.0, 20.0), "SIM_GYR1_RND": (0.0, 100.0), "SIM_ACC1_RND": (0.0, 100.0),
    "SIM_VIB_FREQ_X": (0.0, 400.0), "SIM_MAG1_FAIL": (0.0, 2.0), "SIM_MAG2_FAIL": (0.0, 2.0),
    "SIM_MAG3_FAIL": (0.0, 2.0), "SIM_MAG1_OFS_X": (-1000.0, 1000.0), "SIM_MAG1_SCALING": (0.0, 2.0),
    "SIM_MAG_MOT_X": (-100.0, 100.0), "SIM_MAG_RND": (0.0, 100.0), "SIM_ENGINE_LAG": (0.0, 2.0),
    "SIM_SERVO_SPEED": (0.0, 2.0), "SIM_FLOW_RND": (0.0, 10.0), "SIM_BARO_COUNT": (0.0, 3.0),
}  # fmt: skip
"""Parameters -> least and greatest value."""

PARTS: tuple[dict[str, float], ...] = (
    {"MNT1_TYPE": 1, "SERVO9_FUNCTION": 6, "SERVO10_FUNCTION": 7, "SERVO11_FUNCTION": 8},
    {"WINCH_TYPE": 1, "SERVO9_FUNCTION": 88}, {"SPRAY_ENABLE": 1, "SERVO9_FUNCTION": 22, "SERVO10_FUNCTION": 23},
    {"GRIP_ENABLE": 1, "GRIP_TYPE": 1, "SERVO9_FUNCTION": 28, "GRIP_AUTOCLOSE": 1},
    {"CHUTE_ENABLED": 1, "SERVO9_FUNCTION": 27}, {"CAM1_TYPE": 1, "SERVO9_FUNCTION": 10, "CAM1_TRIGG_DIST": 1},
    {"CAM1_TYPE": 5}, {"RELAY1_FUNCTION": 1, "RELAY1_PIN": 1, "RELAY2_FUNCTION": 3, "CAM1_TYPE": 2},
    {"FENCE_TYPE": 15, "FENCE_ENABLE": 1, "FENCE_RADIUS": 30, "FENCE_ALT_MAX": 20, "AVOID_ENABLE": 7},
    {"OA_TYPE": 1, "PRX1_TYPE": 2}, {"OA_TYPE": 2, "FENCE_ENABLE": 1}, {"OA_TYPE": 3, "PRX1_TYPE": 10},
    {"TERRAIN_ENABLE": 1, "RTL_ALT_TYPE": 1}, {"RNGFND1_TYPE": 100, "TERRAIN_ENABLE": 1},
    {"FLOW_TYPE": 10, "SIM_FLOW_ENABLE": 1, "EK3_SRC1_POSXY": 0, "EK3_SRC1_VELXY": 5}, {"FLOW_TYPE": 5},
    {"VISO_TYPE": 1, "EK3_SRC1_POSXY": 6, "EK3_SRC1_VELXY": 6, "EK3_SRC1_POSZ": 6, "EK3_SRC1_YAW": 6},
    {"PLND_ENABLED": 1, "PLND_TYPE": 4, "SIM_PLD_ENABLE": 1}, {"PLND_ENABLED": 1, "PLND_TYPE": 1},
    {"FOLL_ENABLE": 1, "FOLL_SYSID": 255}, {"SYS_FAILURE_EN": 1}, {"FRAME_CLASS": 2}, {"FRAME_CLASS": 4},
    {"LOG_DISARMED": 1}, {"LOG_DISARMED": 3, "LOG_BITMASK": 2**20 - 1}, {"BATT_MONITOR": 0}, {"WENC_TYPE": 10},
    {"SIM_TERRAIN": 1}, {"SIM_ESC_TELEM": 1, "SIM_ESC_ARM_RPM": 100}, {"SIM_VIB_MOT_MAX": 300, "INS_HNTCH_ENABLE": 1},
)  # fmt: skip
"""Parameters that are set before a boot, which looks at them."""
