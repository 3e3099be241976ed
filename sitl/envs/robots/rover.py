# SPDX-License-Identifier: BSD-3-Clause
"""The rover as environments drive it."""

from __future__ import annotations

from sitl.autopilot.rover.modes.guided import GUIDED
from sitl.autopilot.rover.modes.manual import MANUAL

from ..actions import ATTITUDE, POSITION, RC_OVERRIDE, VELOCITY
from ..mavlink import target_messages
from .kind import FAR, RobotKind, pulses

ROBOT = RobotKind(
    setpoints=(VELOCITY, RC_OVERRIDE, POSITION, ATTITUDE),
    modes={"rc": MANUAL, "velocity": GUIDED, "position": GUIDED, "attitude": GUIDED},
    guided=GUIDED,
    encode=target_messages.ROVER,
    tick=0.02,
    crash_range=1.5,
    discrete={
        "rc": {  # the paper's
            "forward": pulses(1500, 0, 1900),
            "left": pulses(1100, 0, 1900),
            "right": pulses(1900, 0, 1900),
        },
        "velocity": {
            "forward": (1.2, 0.0, 0.0, 0.0),
            "left": (1.0, 0.0, 0.0, 0.45),
            "right": (1.0, 0.0, 0.0, -0.45),
        },
    },
    continuous={
        "rc": ((1100, 1100), (1900, 1900), (0, 2)),
        "velocity": ((-1.2, -0.6), (1.2, 0.6), (0, 3)),
        "position": ((-FAR, -FAR), (FAR, FAR), (0, 1)),
        "attitude": ((-0.6, -1.0), (0.6, 1.0), (2, 3)),
    },
    agile={},
    takes_off=False,
    feels_wind=False,
)
