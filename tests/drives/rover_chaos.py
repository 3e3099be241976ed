# SPDX-License-Identifier: BSD-3-Clause
"""A soak in which things fail as well: GPS, transmitter, ground station; and parameters change on the way."""

from __future__ import annotations

import math

import numpy as np

from sitl.simulation import Core
from tests.drives.rover_driver import HOLD
from tests.drives.rover_soak import RoverSoak

TUNABLE = {
    "WP_RADIUS": (0, 5), "WP_ACCEL": (0, 3), "WP_JERK": (0, 3), "TURN_RADIUS": (0, 3), "ATC_TURN_MAX_G": (1, 2),
    "ATC_STR_RAT_MAX": (0, 180), "ATC_ACCEL_MAX": (0, 3), "ATC_DECEL_MAX": (0, 3), "ATC_BRAKE": (0, 1),
    "PSC_POS_P": (0, 2), "PSC_VEL_P": (0, 3), "LOIT_TYPE": (0, 2), "LOIT_RADIUS": (0, 5), "CIRC_RADIUS": (0, 30),
    "CIRC_DIR": (0, 1), "SIMPLE_TYPE": (0, 1), "STICK_MIXING": (0, 1), "MIS_DONE_BEHAVE": (0, 3),
    "PILOT_STEER_TYPE": (0, 3), "GUID_OPTIONS": (0, 64), "WP_PIVOT_ANGLE": (0, 90), "WP_PIVOT_RATE": (0, 90),
    "RTL_SPEED": (0, 2), "MOT_SLEWRATE": (0, 200), "FS_ACTION": (0, 4), "FS_CRASH_CHECK": (0, 2),
    "ACRO_TURN_RATE": (0, 180), "SRTL_ACCURACY": (0, 4),
}  # fmt: skip
"""Parameters that a driver may change on the way, and between what; before a rest they are as they were."""


class RoverChaos(RoverSoak):
    """Drives by dice while things fail and parameters change."""

    def __init__(self, core: Core, frame: str, seed: int) -> None:
        super().__init__(core, frame, seed)
        self._before: dict[str, float] = {}

    def check(self) -> None:
        """As in a soak; without GPS the estimate may leave the truth, but hardly in heading."""
        self.check_numbers()
        off = math.degrees(float(self.ap.estimate.euler[2])) - self.heading
        assert abs((off + 180.0) % 360.0 - 180.0) < 15.0, (off, self.story())

    def act(self) -> None:
        """A fault or a parameter now and then."""
        if self.dice.random() < 0.7:
            super().act()
        else:
            self.do_one_of((self.gps, self.transmitter, self.ground_station, self.tune, self.tune))

    def gps(self) -> None:
        self.set_parameter("SIM_GPS1_ENABLE", self.dice.choice((0, 1)))

    def transmitter(self) -> None:
        self.set_parameter("SIM_RC_FAIL", self.dice.choice((0, 1)))

    def ground_station(self) -> None:
        self.send("HEARTBEAT", type=6, autopilot=8, mavlink_version=3)
        self.set_parameter("FS_GCS_ENABLE", self.dice.choice((0, 1, 2)))

    def tune(self) -> None:
        name = self.dice.choice(sorted(TUNABLE))
        self._before.setdefault(name, float(getattr(self.ap.params, name)))
        value = self.dice.randint(*TUNABLE[name])
        self.log.append(f"{name} {value}")
        self.set_parameter(name, value)

    def rest(self) -> None:
        """Everything works again; the estimate is back at the truth by the end."""
        for name, value in (("SIM_GPS1_ENABLE", 1), ("SIM_RC_FAIL", 0), ("FS_GCS_ENABLE", 0), *self._before.items()):
            self.set_parameter(name, value)
        self._before.clear()
        self.let_go()
        self.set_mode(HOLD)
        self.fly(30.0)
        super().rest()
        assert np.linalg.norm(np.array(self.ap.estimate.pos)[:2] - self.place) < 6.0, self.story()
