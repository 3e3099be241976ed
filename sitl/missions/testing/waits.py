# SPDX-License-Identifier: BSD-3-Clause
"""Waiting for what a pilot waits for. Time-outs are simulated seconds; every one raises AssertionError."""

from __future__ import annotations

import math
import re

from .connected import Connected
from .telemetry import Text

BOOT_S = 120.0
"""A vehicle that is not ready by then has a fault."""


def turn(degrees: float) -> float:
    """An angle within +-180 degrees."""
    return (degrees + 180.0) % 360.0 - 180.0


def _range(low: float, high: float, unit: str) -> str:
    if math.isinf(high):
        return f"at least {low:g} {unit}"
    return f"at most {high:g} {unit}" if math.isinf(low) else f"{low:g} to {high:g} {unit}"


class Waits(Connected):
    """A vehicle that can be waited for. ``hold``: so long must it stay so [s]."""

    def wait_ready(self, timeout: float = BOOT_S) -> None:
        """Until it knows where it is and its pre-arm checks are good."""
        __tracebackhide__ = True
        seen = self.telemetry

        def last() -> str:
            place = "position known" if seen.has_position else "no position"
            return f"{place}, pre-arm checks {'good' if seen.checked else 'not good'}"

        self.wait_until(lambda: seen.has_position and seen.checked, timeout, "a vehicle that is ready to arm", last)

    def wait_mode(self, name: str, timeout: float = 30.0) -> None:
        """Until it is in a mode."""
        __tracebackhide__ = True
        self.wait_until(lambda: self.mode == name, timeout, f"mode {name}", lambda: f"mode {self.mode}")

    def wait_armed(self, timeout: float = 30.0) -> None:
        """Until it is armed."""
        __tracebackhide__ = True
        self.wait_until(lambda: self.armed, timeout, f"the {self.kind} to be armed")

    def wait_disarmed(self, timeout: float = 120.0) -> None:
        """Until it is disarmed."""
        __tracebackhide__ = True
        self.wait_until(lambda: not self.armed, timeout, f"the {self.kind} to be disarmed")

    def wait_altitude(self, low: float, high: float = math.inf, timeout: float = 60.0, hold: float = 0.0) -> None:
        """Until its height above home is within ``low`` .. ``high`` [m]."""
        __tracebackhide__ = True
        what = f"an altitude of {_range(low, high, 'm')}"
        self.wait_until(lambda: low <= self.height <= high, timeout, what, lambda: f"{self.height:.2f} m", hold)

    def wait_groundspeed(self, low: float, high: float = math.inf, timeout: float = 60.0, hold: float = 0.0) -> None:
        """Until its speed along the ground is within ``low`` .. ``high`` [m/s]."""
        __tracebackhide__ = True
        what = f"a speed of {_range(low, high, 'm/s')}"
        self.wait_until(
            lambda: low <= self.groundspeed <= high, timeout, what, lambda: f"{self.groundspeed:.2f} m/s", hold
        )

    def wait_climb_rate(self, low: float, high: float = math.inf, timeout: float = 60.0, hold: float = 0.0) -> None:
        """Until it climbs with ``low`` .. ``high`` [m/s]; negative: it sinks."""
        __tracebackhide__ = True
        what = f"a climb rate of {_range(low, high, 'm/s')}"
        self.wait_until(
            lambda: low <= self.climb_rate <= high, timeout, what, lambda: f"{self.climb_rate:.2f} m/s", hold
        )

    def wait_heading(self, degrees: float, accuracy: float = 5.0, timeout: float = 60.0, hold: float = 0.0) -> None:
        """Until its nose points to ``degrees``, within ``accuracy`` [deg]."""
        __tracebackhide__ = True
        what = f"a heading of {degrees:g} within {accuracy:g} deg"

        def points_there() -> bool:
            return abs(turn(self.heading - degrees)) <= accuracy

        self.wait_until(points_there, timeout, what, lambda: f"{self.heading:.1f} deg", hold)

    def wait_distance(self, metres: float, timeout: float = 120.0) -> None:
        """Until it is as far, along the ground, from where it is now."""
        __tracebackhide__ = True
        start = self.position
        self.wait_until(
            lambda: math.dist(self.position[:2], start[:2]) >= metres,
            timeout,
            f"a distance of {metres:g} m from {start.north:.1f} m north, {start.east:.1f} m east",
            lambda: f"{math.dist(self.position[:2], start[:2]):.2f} m",
        )

    def wait_location(
        self,
        north: float,
        east: float,
        height: float | None = None,
        accuracy: float = 1.0,
        timeout: float = 120.0,
        hold: float = 0.0,
    ) -> None:
        """Until it is at a place from home [m], along the ground and in height each within ``accuracy``."""
        __tracebackhide__ = True

        def away() -> float:
            return math.dist(self.position[:2], (north, east))

        def off() -> float:
            return abs(self.height - height) if height is not None else 0.0

        where = f"{north:g} m north, {east:g} m east" + (f", {height:g} m high" if height is not None else "")

        def last() -> str:
            return f"{away():.2f} m away" + (f", {off():.2f} m off its height" if height is not None else "")

        self.wait_until(
            lambda: away() <= accuracy and off() <= accuracy, timeout, f"{where}, within {accuracy:g} m", last, hold
        )

    def wait_waypoint(self, item: int, timeout: float = 300.0) -> None:
        """Until a mission item was reached (MISSION_ITEM_REACHED); an item that was, at once."""
        __tracebackhide__ = True
        self.wait_until(
            lambda: item in self.reached,
            timeout,
            f"mission item {item} to be reached",
            lambda: f"reached {', '.join(map(str, self.reached)) or 'none'}; on the way to {self.telemetry.item}",
        )

    def wait_current_waypoint(self, item: int, timeout: float = 300.0) -> None:
        """Until a mission item is under way (MISSION_CURRENT)."""
        __tracebackhide__ = True
        self.wait_until(
            lambda: self.telemetry.item == item,
            timeout,
            f"mission item {item} to be under way",
            lambda: f"item {self.telemetry.item}",
        )

    def wait_statustext(self, text: str | re.Pattern[str], timeout: float = 60.0, since: float = -1.0) -> Text:
        """Until it says a text: part of it, or a compiled regular expression that is found in it.

        Texts are gone through in order: one that came before this call is found, too, unless it or a later one has
        been found already, or did not come after ``since`` [simulated s].
        """
        __tracebackhide__ = True
        found: list[Text] = []

        def look() -> bool:
            while self._found < len(self.texts) and not found:
                said = self.texts[self._found]
                self._found += 1
                matches = text in said.text if isinstance(text, str) else text.search(said.text)
                if matches and said.time > since:
                    found.append(said)
            return bool(found)

        first = self._found
        what = repr(text) if isinstance(text, str) else f"a text like {text.pattern!r}"
        try:
            self.wait_until(look, timeout, f"status text {what}", lambda: self._heard_since(first))
        finally:
            if not found:
                self._found = first
        return found[0]

    def _heard_since(self, first: int) -> str:
        said = self.texts[first:]
        return f"{len(said)} other texts" if said else "no text at all"
