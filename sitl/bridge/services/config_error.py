# SPDX-License-Identifier: BSD-3-Clause
"""A vehicle whose configuration keeps it from starting says so, until it is mended and rebooted."""

from __future__ import annotations

from ...core.constants import NEVER
from ...core.mavlink import MavSeverity
from ..host import Host
from .service import StatefulService
from .statustext import StatusTextService

EVERY_US = 5_000_000
TEXTS = ("Config Error: Baro: unable to initialise driver", "Config Error: fix problem then reboot")


class ConfigErrorService(StatefulService):
    """No barometer was found at power-on (SIM_BARO_COUNT): the estimator does not start, and nothing can be armed."""

    kept = ("due_us",)

    def __init__(self, bridge: Host) -> None:
        super().__init__(bridge)
        self.due_us = EVERY_US if bridge.vehicle.parameters["SIM_BARO_COUNT"] < 1 else NEVER

    def service(self, now_us: int) -> None:
        self.due_us = now_us + EVERY_US
        for text in TEXTS:
            self.bridge.get(StatusTextService).say(MavSeverity.CRITICAL, text)
