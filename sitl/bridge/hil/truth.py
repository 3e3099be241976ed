# SPDX-License-Identifier: BSD-3-Clause
"""HIL_STATE_QUATERNION: where the vehicle really is. The autopilot passes it on (SIMSTATE) and never uses it."""

from __future__ import annotations

import math

from ...physics.carried import Carried
from ..dialect import message
from ..telemetry.units import uint16
from .numbers import culprit, within

KIND = message("HIL_STATE_QUATERNION")
_LIMITS = (*(1.1,) * 4, *(1e3,) * 3)
_NAMES = ("attitude w", "attitude x", "attitude y", "attitude z", "rollspeed", "pitchspeed", "yawspeed")
NOWHERE = Carried((1.0, 0.0, 0.0, 0.0), (0.0,) * 3, 0, 0, 0, (0,) * 3, (0,) * 3)


def truth_payload(time_us: int, truth: Carried) -> bytes:
    """The message; air speed is the speed over the ground, as without wind."""
    speed = uint16(math.hypot(*truth.velocity))
    place = truth.lat, truth.lon, truth.alt
    return KIND.pack(time_us, *truth.attitude, *truth.rates, *place, *truth.velocity, speed, speed, *truth.acceleration)


def read_truth(payload: bytes) -> tuple[int, Carried]:
    """Time [us] and truth.

    Raises:
        RefusedError: attitude or rates that are not finite or absurd.
    """
    t, *values = KIND.unpack_from(payload.ljust(KIND.size, b"\0"))
    if not within(values[:7], _LIMITS):
        raise culprit(KIND.name, _NAMES, values[:7], _LIMITS)
    a, b, c, d, p, q, r, lat, lon, alt, vn, ve, vd, _, _, ax, ay, az = values
    return t, Carried((a, b, c, d), (p, q, r), lat, lon, alt, (vn, ve, vd), (ax, ay, az))
