# SPDX-License-Identifier: BSD-3-Clause
"""Texts for the pilot (STATUSTEXT), and the events of the core that give them."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

from ...autopilot import events as core
from ...autopilot.estimation.external import BY_OTHERS, YAW_BY_OTHERS
from ...autopilot.estimation.flow import BY_FLOW
from ...autopilot.mission.notes import CurrentChanged, ItemReached, OutputItem, ParametersFound, Switched, Text
from ..channel import Channel
from ..dialect import message
from ..wire.port import NEVER
from .flight_state import FlightStateService
from .home import HomeService
from .service import CRITICAL, INFO, WARNING, Service
from .terrain import TerrainService

TEXT_BYTES = 50
KIND = message("STATUSTEXT")


class StatusTextService(Service):
    """Texts longer than 50 bytes go out in numbered pieces.

    The last of which ends with a NUL (MAVLink 2 only).

    A MAVLink 1 client gets the first 50 bytes.
    """

    _id = 0

    def snapshot(self) -> int:
        return self._id

    def restore(self, state: int) -> None:
        self._id = state

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

TEXTS = {
    core.EKF_INITIALISED: (INFO, "EKF3 IMU{a:.0f} initialised"),
    core.EKF_TILT_ALIGNED: (INFO, "EKF3 IMU{a:.0f} tilt alignment complete"),
    core.EKF_YAW_ALIGNED: (INFO, "EKF3 IMU{a:.0f} MAG{b:.0f} initial yaw alignment complete"),
    core.EKF_YAW_ALIGNED_IN_FLIGHT: (INFO, "EKF3 IMU{a:.0f} MAG{b:.0f} in-flight yaw alignment complete"),
    core.EKF_ORIGIN_SET: (INFO, "EKF3 IMU{a:.0f} origin set"),
    core.EKF_USES_GPS: (INFO, "EKF3 IMU{a:.0f} is using GPS"),
    core.EKF_STOPPED_GPS: (WARNING, "EKF3 IMU{a:.0f} stopped aiding"),
    core.EKF_STOPPED_AIDING: (WARNING, "EKF3 IMU{a:.0f} stopped aiding"),
    core.EKF_RELATIVE: (INFO, "EKF3 IMU{a:.0f} started relative aiding"),
    core.EKF_EMERGENCY_YAW: (WARNING, "EKF3 IMU{a:.0f} emergency yaw reset"),
    core.EKF_COMPASS_CHANGED: (INFO, "EKF3 IMU{a:.0f} switching to compass {b:.0f}"),
    core.EKF_LANE_SWITCHED: (CRITICAL, "EKF3 lane switch {a:.0f}"),
    core.NO_WAY: (CRITICAL, "Dijkstra: could not find path"),
    core.HIT_OBSTACLE: (INFO, "SIM Hit obstacle at {a:f} m/s"),
}
"""Event code -> (severity, text with the event's numbers a and b), of every firmware."""

HEARTBEAT = message("HEARTBEAT").id
MISSION_CURRENT = message("MISSION_CURRENT").id
FENCE_STATUS = message("FENCE_STATUS").id
REACHED = message("MISSION_ITEM_REACHED")
E = "autopilot.events."
SOURCES = {BY_FLOW: "fusing optical flow", BY_OTHERS: "is using external nav data", YAW_BY_OTHERS: "yaw aligned"}
"""What a filter uses now (EKF_USES)."""


class EventService(Service):
    """Reads the ring of events; says texts; tells of home, origin and the mission's progress."""

    def __init__(self, bridge: Any) -> None:
        super().__init__(bridge)
        self._texts = {**TEXTS, **bridge.profile.texts}
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
        self.bridge.get(StatusTextService).say(INFO, BOOT_TEXTS[self._boot_text][1])
        self._boot_text += 1
        self._find_due()

    def snapshot(self) -> tuple[int, int]:
        return (self._seen, self._boot_text)

    def restore(self, state: tuple[int, int]) -> None:
        self._seen, self._boot_text = state
        self._find_due()

    def read(self) -> None:
        """Tell of every event since the last call."""
        count = int(self._count())
        if count == self._seen:
            return
        ring = self.bridge.vehicle.v.autopilot.events
        for k in range(max(self._seen, count - core.EVENT_RING), count):
            at = k % core.EVENT_RING
            self._tell(int(ring.code[at]), float(ring.a[at]), float(ring.b[at]))
        self._seen = count
        self.bridge.get(HomeService).tell_changes()

    def _tell(self, code: int, a: float, b: float) -> None:
        say = self.bridge.get(StatusTextService).say
        if code in self._texts:
            severity, text = self._texts[code]
            say(severity, text.format(a=a, b=b))
        if code == core.EKF_USES:
            self._say_source(int(a), b)
        if code == core.FENCE_BREACHED:
            self.bridge.send_to_all(FENCE_STATUS)
        if code == core.TERRAIN_LEFT:
            self.bridge.get(TerrainService).look_up()
        if code in (core.ARMED, core.DISARMED):
            self.bridge.get(PreArmService).find_due()
            for service in self.bridge.services.values():
                service.arming_changed()
        if code == core.EKF_INITIALISED:
            say(INFO, "AHRS: EKF3 active")
        elif code == core.EKF_ORIGIN_SET:
            altitude = float(self.bridge.vehicle.v.autopilot.estimate.origin_alt)
            say(INFO, f"Field Elevation Set: {altitude:.0f}m")
        elif code == core.EKF_LANE_SWITCHED:
            say(WARNING, f"EKF primary changed:{a:.0f}")
        elif code == core.MODE_CHANGED:
            self.bridge.send_to_all(HEARTBEAT)
        else:
            self.notes(self.bridge.autopilot.texts_of(code, a, b))

    def _say_source(self, imu: int, source: float) -> None:
        say, ekf = self.bridge.get(StatusTextService).say, self.bridge.vehicle.v.autopilot.ekf
        say(INFO, f"EKF3 IMU{imu} {SOURCES[source]}")
        if source == BY_OTHERS:
            for name, unit, (north, east, down) in (("pos", "m", ekf.pos), ("vel", "m/s", ekf.vel)):
                say(INFO, f"EKF3 IMU{imu} initial {name} NED = {north:.1f},{east:.1f},{down:.1f} ({unit})")

    def notes(self, notes: Sequence[Any]) -> None:
        """Texts and progress that the mission's sequencer or a law gave back."""
        for note in notes:
            if isinstance(note, Text):
                self.bridge.get(StatusTextService).say(note.severity, note.text)
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


class PreArmService(Service):
    """https://ardupilot.org/copter/docs/common-prearm-safety-checks.html"""

    due_us = EVERY_US

    def service(self, now_us: int) -> None:
        self.find_due()
        if not self.bridge.autopilot.armed():
            self.bridge.autopilot.run_prearm_checks()
            self.bridge.say_pending()

    def find_due(self) -> None:
        """It was armed, disarmed or checked: an armed vehicle is checked no more."""
        armed = self.bridge.autopilot.armed()
        self.due_us = NEVER if armed else (self.bridge.now_us // EVERY_US + 1) * EVERY_US

    def snapshot(self) -> int:
        return self.due_us

    def restore(self, state: Any) -> None:
        self.due_us = state
