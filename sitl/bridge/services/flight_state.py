# SPDX-License-Identifier: BSD-3-Clause
"""What clients ask for now and then: FLIGHT_INFORMATION, AUTOPILOT_STATE_FOR_GIMBAL_DEVICE, MISSION_ITEM_REACHED."""

from __future__ import annotations

from collections.abc import Callable

from ...core.algebra import rotate
from ...core.mavlink import MavLandedState
from ..dialect import message
from ..host import Host
from ..telemetry.plain import built
from ..telemetry.units import boot_ms
from .service import StatefulService

NONE_REACHED = 0xFFFF


class FlightStateService(StatefulService):
    """When it was armed and took off, which item of the mission it reached last, and what a gimbal needs."""

    kept = ("_took_off_us", "_reached")

    def __init__(self, bridge: Host) -> None:
        super().__init__(bridge)
        self._took_off_us = 0
        self._reached = NONE_REACHED

    def messages(self) -> dict[str, Callable[[], bytes]]:
        return {
            "FLIGHT_INFORMATION": self.flight,
            "AUTOPILOT_STATE_FOR_GIMBAL_DEVICE": self.for_gimbal,
            "MISSION_ITEM_REACHED": self.last_reached,
        }

    def reached(self, seq: int) -> None:
        """An item of the mission was reached."""
        self._reached = seq

    def last_reached(self) -> bytes:
        """MISSION_ITEM_REACHED: the item of the mission that was reached last, 65535: none."""
        return message("MISSION_ITEM_REACHED").payload(seq=self._reached)

    def flight(self) -> bytes:
        """FLIGHT_INFORMATION: arming and take-off [us since boot, whatever the fields' names say]; the take-off is when
        somebody first asked in flight, as in ArduPilot."""
        now, ap = self.bridge.now_us, self.bridge.vehicle.v.autopilot
        sent_state = built(self.bridge.profile, self.bridge.vehicle.v, "EXTENDED_SYS_STATE")
        state = int(getattr(sent_state, "landed_state", 0))
        if state == MavLandedState.ON_GROUND:
            self._took_off_us = 0
        elif state >= MavLandedState.IN_AIR and not self._took_off_us:
            self._took_off_us = now
        return message("FLIGHT_INFORMATION").payload(
            time_boot_ms=boot_ms(now),
            arming_time_utc=max(int(ap.arming.armed_us), 0),
            takeoff_time_utc=self._took_off_us,
        )

    def for_gimbal(self) -> bytes:
        """AUTOPILOT_STATE_FOR_GIMBAL_DEVICE: attitude, velocity [m/s], yaw rate wanted and estimated [rad/s], status of
        the estimate."""
        estimate = self.bridge.vehicle.v.autopilot.estimate
        q, velocity = estimate.q, estimate.vel
        return message("AUTOPILOT_STATE_FOR_GIMBAL_DEVICE").payload(
            target_system=self.bridge.system,
            time_boot_us=self.bridge.now_us & 0xFFFFFFFF,
            q=(q.w, q.x, q.y, q.z),
            vx=velocity.x,
            vy=velocity.y,
            vz=velocity.z,
            feed_forward_angular_velocity_z=self.bridge.autopilot.yaw_rate_target(),
            estimator_status=int(estimate.status_flags) & 0xFFFF,
            angular_velocity_z=rotate(q, estimate.rates).z,
        )
