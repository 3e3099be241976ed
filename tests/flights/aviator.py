# SPDX-License-Identifier: BSD-3-Clause
"""A test pilot of copters."""

from __future__ import annotations

import numpy as np

from sitl.core.mavlink import MavCmd
from sitl.physics.native import truth
from sitl.simulation import Core
from tests.pilots.witness import MIDDLE, Item, Witness

STABILIZE, ACRO, ALT_HOLD, AUTO, GUIDED, LOITER, RTL, CIRCLE, LAND, DRIFT = 0, 1, 2, 3, 4, 5, 6, 7, 9, 11
SPORT, FLIP, POSHOLD, BRAKE, THROW, GUIDED_NOGPS, SMART_RTL, ZIGZAG, AUTO_RTL = 13, 14, 16, 17, 18, 20, 21, 24, 27
AIRFRAMES = ("erle_copter", "ardupilot_quad")


class Aviator(Witness):
    """Flies one copter."""

    def __init__(self, core: Core, frame: str = "erle_copter", *, seed: int = 0, **params: float) -> None:
        super().__init__(core, frame, seed=seed, **params)

    @property
    def height(self) -> float:
        """True height above home [m]."""
        return float(-self.pos[2])

    @property
    def on_ground(self) -> bool:
        """Whether it truly stands on the ground."""
        return truth.read(self.simulation.v).on_ground

    def ready(self) -> Aviator:
        """Boot, until armable in GUIDED."""
        self.boot()
        self.fly(0.1)
        return self

    def hover(self, height: float = 10.0) -> Aviator:
        """Boot, arm and take off in GUIDED, and wait until it hovers."""
        self.ready()
        self.arm()
        self.take_off(height)
        return self

    def take_off(self, height: float) -> None:
        """Take off, armed in GUIDED."""
        assert self.ask(MavCmd.NAV_TAKEOFF, 0, 0, 0, 0, 0, 0, height) == 0
        assert self.fly(30.0 + height, lambda: self.height > height - 0.5), f"at {self.height} m, {self.texts}"
        self.fly(4.0)

    def hold(self, roll: int = MIDDLE, pitch: int = MIDDLE, throttle: int = MIDDLE, yaw: int = MIDDLE) -> None:
        """Hold the sticks from now on [us]."""
        self._pulses = (roll, pitch, throttle, yaw)

    def sticks(self, seconds: float, **held: int) -> None:
        """Hold the sticks for a time [us]; what is not given is centred."""
        self.hold(**held)
        self.fly(seconds)

    def start_mission(self, *items: Item) -> None:
        """Upload, arm in GUIDED, AUTO, MISSION_START."""
        assert self.upload(*items) == 0
        self.arm()
        assert self.set_mode(AUTO)
        assert self.ask(300, 0, 0) == 0


POSITION, VELOCITY, ACCELERATION, POS_VEL, POS_VEL_ACCEL = 0xDF8, 0xDC7, 0xC3F, 0xDC0, 0xC00
POSITION_YAW, POSITION_YAW_RATE, VELOCITY_YAW_RATE = 0x9F8, 0x5F8, 0x5C7


target, stream = Aviator.target, Aviator.stream
"""One set-point, and the same at 10 Hz: ``target(p, mask, frame, **fields)``."""


def estimate(p: Aviator) -> np.ndarray:
    """Estimated position, which set-points refer to."""
    return np.array(p.ap.estimate.pos)
