# SPDX-License-Identifier: BSD-3-Clause
"""A test pilot of rovers, and how well an airframe drives: the metrics of docs/vehicles.md."""

from __future__ import annotations

import itertools
import math
from typing import Any

import numpy as np

from sitl.client import Moment
from sitl.core.mavlink import MavCmd
from sitl.simulation import Core
from tests.pilots.witness import KEEP, MIDDLE, Item, Witness

MANUAL, ACRO, STEERING, HOLD, LOITER, SIMPLE, CIRCLE, AUTO, RTL, SMART_RTL, GUIDED = 0, 1, 3, 4, 5, 7, 9, 10, 11, 12, 15
MODES = (MANUAL, ACRO, STEERING, HOLD, LOITER, SIMPLE, CIRCLE, AUTO, RTL, SMART_RTL, GUIDED)
AIRFRAMES = ("erle_rover", "erle_rover_small", "ardupilot_rover", "skid_rover")
POSITION, VELOCITY, VELOCITY_YAW, VELOCITY_YAW_RATE, YAW, YAW_RATE = 0xDF8, 0xDC7, 0x9C7, 0x5C7, 0x9FF, 0x5FF
"""Masks of SET_POSITION_TARGET."""
BODY = 8


_READY: dict[tuple[object, ...], tuple[Moment, list[Any], list[Any]]] = {}
"""Rovers that have booted, by what they were made with: the moment, and the rows of their driver."""


class Driver(Witness):
    """Drives one rover."""

    def __init__(self, core: Core, frame: str, *, seed: int = 0, estimator: str = "ekf", **params: float) -> None:
        super().__init__(core, frame, seed=seed, estimator=estimator, **params)
        self._made_with = (frame, seed, estimator, *sorted(params.items()))

    # ------------------------------------------------------------------ what is true

    @property
    def place(self) -> np.ndarray:
        """True north and east of home [m]."""
        return self.pos[:2]

    @property
    def speed(self) -> float:
        """True speed along the nose [m/s], backward negative."""
        heading = math.radians(self.heading)
        return float(self.vel[0] * math.cos(heading) + self.vel[1] * math.sin(heading))

    @property
    def heading(self) -> float:
        """True heading [deg], -180 to 180."""
        return float(self.euler[2])

    @property
    def cruise(self) -> float:
        """The airframe's own speed along legs [m/s], WP_SPEED."""
        return float(self.ap.params.WP_SPEED)

    @property
    def radius(self) -> float:
        """Of its tightest turn [m], TURN_RADIUS."""
        return float(self.ap.params.TURN_RADIUS)

    @property
    def is_skid(self) -> bool:
        """Whether it turns on the spot."""
        return int(self.ap.params.SERVO1_FUNCTION) == 73

    def away(self, north: float, east: float) -> float:
        """True distance to a place, which counts from where the estimator has its origin [m]."""
        return float(np.hypot(*(self.place - self.true(north, east))))

    def true(self, north: float, east: float) -> np.ndarray:
        """Where the estimator's place truly is: its error is not the driver's [m]."""
        return np.array((north, east)) + self.place - np.array(self.ap.estimate.pos)[:2]

    # ------------------------------------------------------------------ driving

    def ready(self) -> Driver:
        """Boot, until armable in GUIDED; one that was made alike has done it already."""
        known = _READY.get(self._made_with)
        if known is None:
            self.boot()
            self.fly(0.1)
            _READY[self._made_with] = (self.snapshot(), list(self.rows), list(self.track))
            return self
        self.connection.run(0)  # the vehicle reads what its client has asked for
        self.restore(known[0])
        self.rows, self.track = list(known[1]), list(known[2])
        return self

    def armed_in(self, mode: int = GUIDED) -> Driver:
        """Boot, arm, change to a mode."""
        self.ready()
        self.arm(0.2)
        assert self.set_mode(mode), self.texts
        return self

    def hold(self, steering: int = MIDDLE, throttle: int = MIDDLE) -> None:
        """Hold the sticks from now on [us]."""
        self._pulses = (steering, KEEP, throttle)

    def sticks(self, seconds: float, steering: int = MIDDLE, throttle: int = MIDDLE) -> None:
        """Hold the sticks for a time [us]; what is not given is centred."""
        self.hold(steering, throttle)
        self.fly(seconds)

    def stands(self) -> bool:
        """Whether it stands."""
        return abs(self.speed) < 0.02

    def wait_until_it_stands(self, seconds: float = 30.0) -> None:
        """Until it has stood for half a second."""
        since = self.now

        def stands() -> bool:
            nonlocal since
            since = since if self.stands() else self.now
            return self.now - since > 0.5

        assert self.fly(seconds, stands), f"still at {self.speed} m/s, {self.texts[-3:]}"

    def get_going(self, speed: float | None = None, seconds: float = 8.0) -> None:
        """Drive north in GUIDED (at WP_SPEED) for a time."""
        self.stream(seconds, VELOCITY, vx=self.cruise if speed is None else speed)

    def start_mission(self, *items: Item) -> None:
        """Upload, AUTO; armed."""
        assert self.upload(*items) == 0
        self.telemetry.reached.clear()
        assert self.set_mode(AUTO), self.texts

    def finish_mission(self, seconds: float) -> None:
        """Until it says that it is through."""
        assert self.fly(seconds, lambda: self.said("Mission Complete")), (self.reached, self.texts[-4:])


def path_error(rows: np.ndarray, *corners: Any) -> np.ndarray:
    """Distance [m] of each row (time, position ...) from the line through the corners."""
    points = rows[:, 1:3]
    best = np.full(len(points), np.inf)
    for a, b in itertools.pairwise(corners):
        a, along = np.array(a), np.subtract(b, a)
        share = np.clip((points - a) @ along / (along @ along), 0.0, 1.0)
        best = np.minimum(best, np.hypot(*(points - a - share[:, None] * along).T))
    return best


SIDE = {"erle_rover": 20.0, "erle_rover_small": 4.0, "ardupilot_rover": 60.0, "skid_rover": 20.0}
"""A square that suits the vehicle [m]."""


def square(side: float) -> list[tuple[float, float]]:
    """Its corners, the first at the start, to which it returns."""
    return [(0.0, 0.0), (side, 0.0), (side, side), (0.0, side), (0.0, 0.0)]


def eight(radius: float) -> list[tuple[float, float]]:
    """Two circles, each of twelve places."""
    angles = np.linspace(0.0, 2.0 * math.pi, 13)[1:]
    return [(radius * math.sin(a), side * radius * (1.0 - math.cos(a))) for side in (1, -1) for a in angles]


def drive_along(core: Core, frame: str, places: list[tuple[float, float]], estimator: str) -> np.ndarray:
    """What a mission through these places drove."""
    d = Driver(core, frame, estimator=estimator).armed_in()
    start = d.now
    d.start_mission(*(Item(MavCmd.NAV_WAYPOINT, place) for place in places))
    d.finish_mission(60.0 + 3.0 * sum(map(math.dist, places, places[1:])) / d.cruise)
    d.wait_until_it_stands()
    return d.since(start)


def outside(rows: np.ndarray, side: float) -> float:
    """Furthest that the square was left to its outside [m]."""
    return float(np.maximum(-rows[:, 1:3], rows[:, 1:3] - side).max())


def metrics(core: Core, frame: str) -> dict[str, float]:
    """All of them, by the column of the table."""
    side = SIDE[frame]
    corners = square(side)
    rows = drive_along(core, frame, corners[1:], "truth")
    by_gps = drive_along(core, frame, corners[1:], "ekf")
    places = [(0.0, 0.0), *eight(0.3 * side)]
    d = Driver(core, frame, estimator="truth").armed_in()
    start, v = d.now, d.cruise
    d.stream(12.0, VELOCITY, vx=v)
    speeds = np.hypot(*d.since(start)[:, 4:6].T)
    fast = float(d.since(start)[int(np.argmax(speeds > 0.9 * v)), 0] - start)
    stops = []
    for mode in (LOITER, HOLD):
        d = Driver(core, frame, estimator="truth").armed_in()
        d.get_going(seconds=12.0)
        place = d.place
        d.set_mode(mode)
        d.wait_until_it_stands(60.0)
        stops.append(float(np.hypot(*(d.place - place))))
    return {
        "cuts a corner by": max(float(np.hypot(*(rows[:, 1:3] - corner).T).min()) for corner in corners[1:4]),
        "runs wide by": outside(rows, side),
        "runs wide by, with GPS": outside(by_gps, side),
        "off the eight, RMS": float(
            np.sqrt(np.mean(path_error(drive_along(core, frame, places[1:], "truth"), *places) ** 2))
        ),
        "90 % of the speed after": fast,
        "overshoot": float(speeds.max() / v - 1.0) * 100.0,
        "stops in (LOITER)": stops[0],
        "rolls out (HOLD)": stops[1],
    }
