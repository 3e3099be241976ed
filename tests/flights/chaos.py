# SPDX-License-Identifier: BSD-3-Clause
"""A soak in which things fail as well: GPS, transmitter, ground station, weather; and parameters change in flight."""

from __future__ import annotations

import numpy as np

from tests.flights import aviator
from tests.flights.aviator import GUIDED
from tests.flights.soak import Soak

TUNABLE = {
    "WPNAV_SPEED": (50, 1500), "WPNAV_ACCEL": (100, 400), "WPNAV_RADIUS": (20, 800), "WPNAV_SPEED_UP": (50, 500),
    "WPNAV_SPEED_DN": (50, 300), "RTL_ALT": (0, 4000), "LAND_SPEED": (30, 100), "ANGLE_MAX": (2000, 4500),
    "LOIT_SPEED": (100, 1500), "PILOT_SPEED_UP": (50, 500), "WP_YAW_BEHAVIOR": (0, 3), "GUID_TIMEOUT": (1, 5),
}  # fmt: skip
"""Parameters that a pilot may change in flight, and between what."""


class Chaos(Soak):
    """Flies by dice while things fail."""

    def check(self) -> None:
        """As in a soak; without GPS the estimate may leave the truth, but hardly in attitude."""
        assert self.mode in (0, 2, 3, 4, 5, 6, 9, 17), self.story()
        self.check_numbers()
        off = np.degrees(np.array(self.ap.estimate.euler)) - self.euler
        off = (off + 180.0) % 360.0 - 180.0
        assert np.abs(off).max() < 12.0 or self.height < 0.5, (off, self.story())

    def act(self) -> None:
        """A fault or a parameter now and then."""
        if self.dice.random() < 0.75:
            super().act()
            return
        self.do_one_of((self.gps, self.transmitter, self.ground_station, self.weather, self.tune))

    def set_target(self) -> None:
        if self.mode == GUIDED or self.set_mode(GUIDED):
            super().set_target()

    def gps(self) -> None:
        self.set_parameter("SIM_GPS1_ENABLE", self.dice.choice((0, 1)))

    def transmitter(self) -> None:
        fails = self.dice.choice((0, 1))
        self.set_parameter("SIM_RC_FAIL", fails)
        if fails:
            self.let_go()

    def ground_station(self) -> None:
        self.send("HEARTBEAT", type=6, autopilot=8, mavlink_version=3)
        self.set_parameter("FS_GCS_ENABLE", self.dice.choice((0, 1, 5, 7)))

    def tune(self) -> None:
        name = self.dice.choice(sorted(TUNABLE))
        self.set_parameter(name, self.dice.randint(*TUNABLE[name]))

    def land(self) -> None:
        """Everything works again; the estimate is back at the truth by the end."""
        for name, value in (("SIM_GPS1_ENABLE", 1), ("SIM_RC_FAIL", 0), ("FS_GCS_ENABLE", 0), ("WPNAV_SPEED_DN", 150)):
            self.set_parameter(name, value)
        self.hold(throttle=aviator.MIDDLE)
        self.fly(12.0)
        super().land()
        assert np.linalg.norm(np.array(self.ap.estimate.pos) - self.pos) < 6.0, self.story()
