# SPDX-License-Identifier: BSD-3-Clause
"""Texts for the pilot (STATUSTEXT), and the events of the core that give them."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import Any

from ...autopilot.arming_checks import ARMED, DISARMED
from ...autopilot.events import EVENT_RING
from ...autopilot.fence.checks import FENCE_BREACHED
from ...autopilot.mission.notes import OutputItem
from ...autopilot.modes import MODE_CHANGED
from ...autopilot.notes import ChecksFailed, CurrentChanged, ItemReached, ParametersFound, Switched, Text
from ...autopilot.terrain.ground import TERRAIN_LEFT
from ...core.constants import NEVER
from ...core.mavlink import MavSeverity
from ..channel import Channel
from ..dialect import message
from ..host import Host
from .flight_state import FlightStateService
from .home import HomeService
from .service import Service, StatefulService
from .terrain_protocol import TerrainService

TEXT_BYTES = 50
KIND = message("STATUSTEXT")


class StatusTextService(StatefulService):
    """Texts longer than 50 bytes go out in numbered pieces.

    The last of which ends with a NUL (MAVLink 2 only).

    A MAVLink 1 client gets the first 50 bytes.
    """

    kept = ("_id",)

    _id = 0

    def say(self, severity: int, text: str) -> None:
        """Send ``text`` with a MAV_SEVERITY to every channel."""
        data = text.encode("ascii", "replace")
        for listener in self.bridge.listeners:
            listener.said(severity, text)
        pieces = self._pieces(severity, data)
        for channel in self.bridge.channels:
            self._send(channel, pieces)

    def _pieces(self, severity: int, data: bytes) -> list[bytes]:
        if len(data) <= TEXT_BYTES:
            return [KIND.payload(severity=severity, text=data)]
        self._id = self._id % 65535 + 1
        count = len(data) // TEXT_BYTES + 1  # a text of 100 bytes needs an empty third piece for its NUL
        parts = [data[k * TEXT_BYTES : (k + 1) * TEXT_BYTES] for k in range(count)]
        return [KIND.payload(severity=severity, text=p, id=self._id, chunk_seq=k) for k, p in enumerate(parts)]

    @staticmethod
    def _send(channel: Channel, pieces: list[bytes]) -> None:
        for payload in pieces if channel.version == 2 else pieces[:1]:
            channel.put(KIND, payload)


BOOT_TEXTS = ((0, "Barometer 1 calibration complete"), (2_450_000, "ArduPilot Ready"))
"""(simulated us after boot, text)"""

HEARTBEAT = message("HEARTBEAT").id
MISSION_CURRENT = message("MISSION_CURRENT").id
FENCE_STATUS = message("FENCE_STATUS").id
REACHED = message("MISSION_ITEM_REACHED")
E = "autopilot.events."


class EventService(Service):
    """Reads the ring of events; says texts; reports home, origin and the mission's progress."""

    def __init__(self, bridge: Host) -> None:
        super().__init__(bridge)
        self._events = bridge.vehicle.firmware.events
        self._acts: dict[int, Callable[[], None]] = {
            ARMED: bridge.arming_changed,
            DISARMED: bridge.arming_changed,
            MODE_CHANGED: lambda: bridge.send_to_all(HEARTBEAT),
            FENCE_BREACHED: lambda: bridge.send_to_all(FENCE_STATUS),
            TERRAIN_LEFT: lambda: bridge.get(TerrainService).look_up(),
        }
        self._count = bridge.reader.field(E + "count")
        self._seen = 0
        self._boot_text = 0

    def channel_added(self, channel: Any) -> None:
        self._find_due()

    def channel_removed(self, channel: Any) -> None:
        self._find_due()

    def _find_due(self) -> None:
        """Events stop the core; only the texts of booting come by the clock, once somebody listens."""
        more = self._boot_text < len(BOOT_TEXTS) and self.bridge.channels
        self.due_us = BOOT_TEXTS[self._boot_text][0] if more else NEVER

    def service(self, now_us: int) -> None:
        self.bridge.get(StatusTextService).say(MavSeverity.INFO, BOOT_TEXTS[self._boot_text][1])
        self._boot_text += 1
        self._find_due()

    def snapshot(self) -> tuple[int, int]:
        return (self._seen, self._boot_text)

    def restore(self, state: tuple[int, int]) -> None:
        self._seen, self._boot_text = state
        self._find_due()

    def read(self) -> None:
        """Report every event since the last call."""
        count = int(self._count())
        if count == self._seen:
            return
        ring = self.bridge.vehicle.v.autopilot.events
        for k in range(max(self._seen, count - EVENT_RING), count):
            at = k % EVENT_RING
            self._report(int(ring.code[at]), float(ring.a[at]), float(ring.b[at]))
        self._seen = count
        self.bridge.get(HomeService).report_changes()

    def _report(self, code: int, a: float, b: float) -> None:
        if code in self._acts:
            self._acts[code]()
        if code in self._events:
            self.notes(self._events[code].notes(self.bridge.vehicle.v, a, b))

    def notes(self, notes: Sequence[Any]) -> None:
        """Texts and progress that the mission's sequencer or a law gave back."""
        for note in notes:
            if isinstance(note, Text):
                self.bridge.get(StatusTextService).say(note.severity, note.text)
            elif isinstance(note, ChecksFailed):
                for text in self.bridge.autopilot.refusal_texts(note.failed):
                    self.bridge.get(StatusTextService).say(MavSeverity.CRITICAL, text)
            elif isinstance(note, ItemReached):
                if note.is_sent:
                    self.bridge.broadcast(REACHED, REACHED.pack(note.seq))
                    self.bridge.get(FlightStateService).reached(note.seq)
                for listener in self.bridge.listeners:
                    listener.reached(note.seq)
            elif isinstance(note, OutputItem):
                self.bridge.carry_out(note.item)
            elif isinstance(note, Switched):
                self.bridge.switched(note.function, note.position)
            elif isinstance(note, CurrentChanged):
                self.bridge.send_to_all(MISSION_CURRENT)
            elif isinstance(note, ParametersFound):
                self.bridge.keep_parameters(note.names)


EVERY_US = 30_000_000
"""ArduPilot's period; on whole multiples of it since boot."""


class PreArmService(StatefulService):
    """https://ardupilot.org/copter/docs/common-prearm-safety-checks.html"""

    kept = ("due_us",)
    due_us = EVERY_US

    def service(self, now_us: int) -> None:
        self.find_due()
        if not self.bridge.autopilot.armed():
            self.bridge.autopilot.run_prearm_checks()
            self.bridge.say_pending()

    def arming_changed(self) -> None:
        self.find_due()

    def find_due(self) -> None:
        """It was armed, disarmed or checked: an armed vehicle is checked no more."""
        armed = self.bridge.autopilot.armed()
        self.due_us = NEVER if armed else (self.bridge.now_us // EVERY_US + 1) * EVERY_US
