# SPDX-License-Identifier: BSD-3-Clause
"""Heartbeats of ground stations: the one named by MAV_GCS_SYSID keeps the ground-station failsafe away."""

from __future__ import annotations

from typing import Any

from ..channel import Channel
from .service import Handler, Sender, Service


class HeartbeatService(Service):
    """Heartbeats of ground stations (https://mavlink.io/en/services/heartbeat.html); our own is a stream."""

    def handlers(self) -> dict[str, Handler]:
        return {"HEARTBEAT": self._heartbeat}

    def _heartbeat(self, channel: Channel, message: Any, sender: Sender) -> None:
        if sender[0] == self.bridge.ground_station:
            self.bridge.vehicle.v.autopilot.modes.failsafe.gcs_us = self.bridge.now_us
