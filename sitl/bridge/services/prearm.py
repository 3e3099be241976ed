# SPDX-License-Identifier: BSD-3-Clause
"""While disarmed, what still keeps the vehicle from arming is said every 30 s ("PreArm: ...")."""

from __future__ import annotations

from typing import Any

from .service import Service

EVERY_US = 30_000_000
"""ArduPilot's period; on whole multiples of it since boot."""


class PreArmService(Service):
    """https://ardupilot.org/copter/docs/common-prearm-safety-checks.html"""

    due_us = EVERY_US

    def service(self, now_us: int) -> None:
        self.due_us = (now_us // EVERY_US + 1) * EVERY_US
        if not self.bridge.autopilot.armed():
            self.bridge.autopilot.run_prearm_checks()
            self.bridge.say_pending()

    def snapshot(self) -> int:
        return self.due_us

    def restore(self, state: Any) -> None:
        self.due_us = state
