# SPDX-License-Identifier: BSD-3-Clause
"""Waiting for what a pilot waits for. Time-outs are simulated seconds; every one raises WaitTimeoutError."""

from __future__ import annotations

import math
import re
from collections.abc import Callable

from sitl.core.mavlink import MavLandedState
from sitl.core.sums import separation

from ..bridge.dialect import message
from ..errors import OptionError
from .session import Session
from .telemetry import Telemetry, Text

__tracebackhide__ = True

BOOT_S = 120.0
"""A vehicle that is not ready by then has a fault."""
READY = "a vehicle that is ready to arm"
"""What ``wait_ready`` waits for, in its error."""


SURE_S = 1.0
"""When a vehicle has said for so long what makes a wait vain, it is over: what was asked before may act late."""


AT_REST = 0.3
"""Slower than this a vehicle stands, or hovers [m/s]."""
FAR_M, FAST = 1.0, 0.5
"""What errors of the estimate of a vehicle at rest do not make up for [m], [m/s]."""


def turn(degrees: float) -> float:
    """An angle within +-180 degrees."""
    return (degrees + 180.0) % 360.0 - 180.0


def _range(low: float, high: float, unit: str) -> str:
    if math.isinf(high):
        return f"at least {low:g} {unit}"
    return f"at most {high:g} {unit}" if math.isinf(low) else f"{low:g} to {high:g} {unit}"


class Waits(Session):
    """A vehicle that can be waited for. ``hold``: so long must it stay so [s]."""

    def wait_ready(self, timeout: float = BOOT_S) -> None:
        """Until it knows where it is and its pre-arm checks are good, at most ``timeout`` [simulated s]."""
        seen = self.telemetry

        def last() -> str:
            position = "position known" if seen.has_position else "no position"
            return f"{position}, pre-arm checks {'good' if seen.checked else 'not good'}"

        self.wait(lambda t: t.has_position and t.checked, timeout, READY, last)

    def wait_mode(self, name: str, timeout: float = 30.0) -> None:
        """Until it is in a mode, at most ``timeout`` [simulated s].

        Raises:
            UnknownNameError: the vehicle has no such mode.
        """
        if not name.isdecimal():  # a mode without a name is shown by its number
            self._mode_number(name)
        self.wait(lambda _: self.mode == name, timeout, f"mode {name}", lambda: f"mode {self.mode}")

    def wait_armed(self, timeout: float = 30.0) -> None:
        """Until it is armed, at most ``timeout`` [simulated s]."""
        self.wait(lambda _: self.armed, timeout, f"the {self.kind} to be armed")

    def wait_disarmed(self, timeout: float = 120.0) -> None:
        """Until it is disarmed, at most ``timeout`` [simulated s]."""
        self.wait(lambda _: not self.armed, timeout, f"the {self.kind} to be disarmed")

    def wait_landed(self, timeout: float = 120.0) -> None:
        """Until it stands on the ground (EXTENDED_SYS_STATE) [simulated s]; a copter disarms a little later."""
        with self.messages("EXTENDED_SYS_STATE", 5.0) as states:
            self.wait(lambda _: states and states[-1].landed_state == MavLandedState.ON_GROUND, timeout,
            f"the {self.kind} to land",
                      lambda: f"{self.telemetry.altitude:.2f} m")  # fmt: skip

    def wait_altitude(self, low: float, high: float = math.inf, timeout: float = 60.0, hold: float = 0.0) -> None:
        """Until its altitude above home is within ``low`` .. ``high`` [m]."""
        in_vain = self._stands(lambda t: low - t.altitude > FAR_M)
        self._wait_range("an altitude", "m", lambda t: t.altitude, low, high, timeout, hold, in_vain)

    def wait_groundspeed(self, low: float, high: float = math.inf, timeout: float = 60.0, hold: float = 0.0) -> None:
        """Until its speed along the ground is within ``low`` .. ``high`` [m/s]."""
        in_vain = self._stands(lambda t: low - t.groundspeed > FAST)
        self._wait_range("a speed", "m/s", lambda t: t.groundspeed, low, high, timeout, hold, in_vain)

    def wait_climb_rate(self, low: float, high: float = math.inf, timeout: float = 60.0, hold: float = 0.0) -> None:
        """Until it climbs with ``low`` .. ``high`` [m/s]; negative: it sinks."""
        in_vain = self._stands(lambda t: low - t.climb_rate > FAST)
        self._wait_range("a climb rate", "m/s", lambda t: t.climb_rate, low, high, timeout, hold, in_vain)

    def _wait_range(
        self, what: str, unit: str, value: Callable[[Telemetry], float], low: float, high: float, timeout: float,
        hold: float, in_vain: Callable[[], str] = lambda: "",
    ) -> None:  # fmt: skip
        if not low <= high:
            raise OptionError(f"{what} from {low:g} to {high:g} {unit} cannot be")
        self.wait(lambda t: low <= value(t) <= high, timeout, f"{what} of {_range(low, high, unit)}",
                  lambda: f"{value(self.telemetry):.2f} {unit}", hold, in_vain)  # fmt: skip

    def _disarmed(self) -> Callable[[], str]:
        """Tells that the vehicle does not move by itself, once it has said so for ``SURE_S`` from now on."""
        begin = self.now

        def why() -> str:
            t = self.telemetry
            if self.armed or not t.heartbeat_at - max(begin, t.disarmed_since) >= SURE_S:
                return ""
            return f"the {self.kind} is disarmed; arm it first"

        return why

    def _stands(self, is_far: Callable[[Telemetry], bool]) -> Callable[[], str]:
        """Tells that the vehicle, which is far from what is awaited, stands disarmed, once it has done so for
        ``SURE_S`` from now on: one that falls, or is moved, may get there."""
        disarmed, moved = self._disarmed(), [self.now]

        def why() -> str:
            t = self.telemetry
            if max(t.groundspeed, abs(t.climb_rate)) > AT_REST or not is_far(t):
                moved[0] = self.now
            return disarmed() if self.now - moved[0] >= SURE_S else ""

        return why

    def _without_item(self, item: int) -> Callable[[], str]:
        """Tells that the vehicle's mission has no such item, once it has said so ``SURE_S`` from now on."""
        begin, asked = self.now, list[float]()

        def why() -> str:
            t = self.telemetry
            if not asked and self.now - begin >= SURE_S:
                asked.append(self.now)
                self.send_command("REQUEST_MESSAGE", message("MISSION_CURRENT").id)  # few are sent unasked
            if t.last_item < 0 or t.mission_at - begin < SURE_S or item <= t.last_item:
                return ""
            return f"its mission ends with item {t.last_item}" if t.last_item else f"the {self.kind} has no mission"

        return why

    def wait_heading(self, degrees: float, accuracy: float = 5.0, timeout: float = 60.0, hold: float = 0.0) -> None:
        """Until its nose points to ``degrees``, within ``accuracy`` [deg]."""
        what = f"a heading of {degrees:g} within {accuracy:g} deg"
        self.wait(
            lambda t: abs(turn(t.heading - degrees)) <= accuracy, timeout, what, lambda: f"{self.heading:.1f} deg", hold
        )

    def wait_distance(self, metres: float, timeout: float = 120.0) -> None:
        """Until it is as far [m], along the ground, from where it is now, at most ``timeout`` [simulated s]."""
        start = self.position
        self.wait(
            lambda t: separation(t.position[:2], start[:2]) >= metres,
            timeout,
            f"a distance of {metres:g} m from {start.north:.1f} m north, {start.east:.1f} m east",
            lambda: f"{separation(self.position[:2], start[:2]):.2f} m",
        )

    def wait_location(
        self,
        north: float,
        east: float,
        altitude: float | None = None,
        accuracy: float = 1.0,
        timeout: float = 120.0,
        hold: float = 0.0,
    ) -> None:
        """Until it is at a position from home [m], along the ground and in altitude each within ``accuracy``."""
        self._wait_location(north, east, altitude, accuracy, timeout, hold)

    def _wait_location(
        self, north: float, east: float, altitude: float | None, accuracy: float, timeout: float, hold: float = 0.0,
        in_vain: Callable[[], str] = lambda: "",
    ) -> None:  # fmt: skip
        if not accuracy >= 0.0:
            raise OptionError(f"accuracy = {accuracy:g} m; it must be 0 or more")

        def away() -> float:
            return separation(self.position[:2], (north, east))

        def off() -> float:
            return abs(self.telemetry.altitude - altitude) if altitude is not None else 0.0

        where = f"{north:g} m north, {east:g} m east" + (f", {altitude:g} m high" if altitude is not None else "")

        def last() -> str:
            return f"{away():.2f} m away" + (f", {off():.2f} m off its altitude" if altitude is not None else "")

        what = f"{where}, within {accuracy:g} m"
        self.wait(lambda _: away() <= accuracy and off() <= accuracy, timeout, what, last, hold, in_vain)

    def wait_waypoint(self, item: int, timeout: float = 300.0) -> None:
        """Until a mission item was reached (MISSION_ITEM_REACHED) [simulated s]; an item that was, at once."""

        def last() -> str:
            return f"reached {', '.join(map(str, self.reached)) or 'none'}; on the way to {self.telemetry.item}"

        what, in_vain = f"mission item {item} to be reached", self._without_item(item)
        self.wait(lambda _: item in self.reached, timeout, what, last, in_vain=in_vain)

    def wait_current_waypoint(self, item: int, timeout: float = 300.0) -> None:
        """Until a mission item is under way (MISSION_CURRENT), at most ``timeout`` [simulated s]."""
        what = f"mission item {item} to be under way"
        last, in_vain = lambda: f"item {self.telemetry.item}", self._without_item(item)
        self.wait(lambda t: t.item == item, timeout, what, last, in_vain=in_vain)

    def wait_statustext(self, text: str | re.Pattern[str], timeout: float = 60.0, since: float = -1.0) -> Text:
        """Until it sends a text: part of it, or a compiled regular expression that is found in it.

        Texts are gone through in order: one that came before this call is found, too, unless it or a later one has
        been found already, or did not come after ``since`` [simulated s].
        """
        found: list[Text] = []

        def look() -> bool:
            while self._texts_read < len(self.texts) and not found:
                said = self.texts[self._texts_read]
                self._texts_read += 1
                matches = text in said.text if isinstance(text, str) else text.search(said.text)
                if matches and said.time > since:
                    found.append(said)
            return bool(found)

        first = self._texts_read
        what = repr(text) if isinstance(text, str) else f"a text like {text.pattern!r}"

        def last() -> str:
            count = len(self.texts) - first
            return f"{count} other texts" if count else "no text at all"

        try:
            self.wait(lambda _: look(), timeout, f"status text {what}", last)
        finally:
            if not found:
                self._texts_read = first
        return found[0]
