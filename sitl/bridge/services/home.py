# SPDX-License-Identifier: BSD-3-Clause
"""Home and origin: SET_GPS_GLOBAL_ORIGIN, SET_HOME_POSITION.

Every change of home or origin is sent to all clients.
"""

from __future__ import annotations

from typing import Any

from ...core.constants import NEVER
from ..channel import Channel
from ..dialect import message
from ..host import Host
from ..listener import Sender
from .service import Handler, StatefulService
from .terrain_protocol import TerrainService

HOME, ORIGIN = message("HOME_POSITION").id, message("GPS_GLOBAL_ORIGIN").id
LOOK_US = 50_000
"""So often home is looked for once there is an origin."""
H, E = "autopilot.home.", "autopilot.estimate.origin_"


class HomeService(StatefulService):
    """Home, and the estimator's origin as long as it has none."""

    kept = ("_sent_home", "_sent_origin", "due_us")

    def __init__(self, bridge: Host) -> None:
        super().__init__(bridge)
        self._home = bridge.reader.fields(H + "is_set", H + "lat", H + "lon", H + "alt")
        self._origin = bridge.reader.fields(E + "set", E + "lat", E + "lon", E + "alt")
        self._sent_home = self._home()
        self._sent_origin = self._origin()
        self.due_us = NEVER

    def handlers(self) -> dict[str, Handler]:
        return {"SET_GPS_GLOBAL_ORIGIN": self._set_origin, "SET_HOME_POSITION": self._set_home}

    def report_changes(self) -> None:
        """Send HOME_POSITION or GPS_GLOBAL_ORIGIN to everyone when they are other than last sent."""
        home, origin = self._home(), self._origin()
        if (home, origin) != (self._sent_home, self._sent_origin):
            self.bridge.get(TerrainService).look_up()
            self.due_us = self.bridge.now_us + LOOK_US if origin[0] and not home[0] else NEVER
        if home != self._sent_home:
            self.bridge.autopilot.home_changed()
        for number, now, sent in ((ORIGIN, origin, self._sent_origin), (HOME, home, self._sent_home)):
            if now != sent and now[0]:
                self.bridge.send_to_all(number)
        self._sent_home, self._sent_origin = home, origin

    def service(self, now_us: int) -> None:
        """Home is set some ticks after the origin, by itself."""
        self.due_us = now_us + LOOK_US if self._origin()[0] and not self._home()[0] else NEVER
        self.report_changes()

    def _set_origin(self, channel: Channel, m: Any, sender: Sender) -> None:
        """Only before the estimator has an origin; else nothing happens, as in ArduPilot."""
        if self._valid(m.latitude, m.longitude):
            if self.bridge.autopilot.set_origin(m.latitude, m.longitude, m.altitude * 1e-3):
                self.report_changes()

    def _set_home(self, channel: Channel, m: Any, sender: Sender) -> None:
        if self._valid(m.latitude, m.longitude):
            if self.bridge.autopilot.set_home(m.latitude, m.longitude, m.altitude * 1e-3):
                self.report_changes()

    @staticmethod
    def _valid(lat: int, lon: int) -> bool:
        return abs(lat) <= 900_000_000 and abs(lon) <= 1_800_000_000 and (lat, lon) != (0, 0)
