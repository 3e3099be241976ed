# SPDX-License-Identifier: BSD-3-Clause
"""Parameters that only the rover has, or that mean something else there; one file a group.

``DEFAULTS``: where the rover's default of a shared parameter differs (ArduRover 4.7).
"""

from __future__ import annotations

DEFAULTS: dict[str, float] = {
    "EK3_VELD_M_NSE": 0.7,
    "EK3_VELNE_M_NSE": 0.5,
    "LOG_BITMASK": 65535,
    "MAV1_EXTRA1": 1,
    "MAV1_EXTRA2": 1,
    "MAV1_EXTRA3": 1,
    "MAV1_EXT_STAT": 1,
    "MAV1_POSITION": 1,
    "MAV1_RAW_CTRL": 1,
    "MAV1_RAW_SENS": 1,
    "MAV1_RC_CHAN": 1,
    "MIS_TOTAL": 0,
    "RC1_DZ": 30,
    "RC2_DZ": 0,
    "RC4_DZ": 30,
}
