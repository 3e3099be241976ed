# SPDX-License-Identifier: BSD-3-Clause
"""The rover firmware behind the MAVLink services, in one place: a changed law is a changed line here."""

from __future__ import annotations

from ...autopilot import home
from ...autopilot.arming_checks import AHRS_TYPE, NEED_POSITION, TEXTS
from ...autopilot.rover import arming, motor_test, parameter_checks
from ...autopilot.rover.control import servos
from ...autopilot.rover.modes import guided_setpoints, mode_list, set_mode
from ...autopilot.rover.modes.auto import AUTO
from ...autopilot.rover.modes.state import Modes
from ...autopilot.rover.navigation import waypoint
from ...core.mavlink import MavSeverity
from ...core.vectors import Vec2
from ..autopilot_api import LONGEST_US, Vector
from ..base_autopilot import BaseAutopilot


class RoverAutopilot(BaseAutopilot):
    """The rover firmware's laws, called on the vehicle's record. Backward speeds are negative."""

    _arming, _set_mode = arming, set_mode
    _auto = AUTO
    _block_order = mode_list.GCS_BLOCK
    _checks = parameter_checks.CHECKS

    # ------------------------------------------------------------------ outputs

    def test_motor(self, motor: int, throttle: float, pulse: int, seconds: float) -> bool:
        """Drive an output: 1 throttle, 2 steering, 3 left, 4 right; at -1 .. 1, or with a pulse [us] that is not 0.

        Only a vehicle that cannot be armed refuses it; a test of an output that it does not have ends as it begins.
        """
        return int(motor_test.start(self._v, motor, throttle, pulse, seconds)) != motor_test.NOT_ARMABLE

    def stick(self, motor: int) -> float:
        """The stick of a motor, -1 .. 1."""
        pilot = self._modes.pilot
        return float(pilot.steering if motor == motor_test.STEERING else pilot.throttle)

    def set_servo(self, number: int, pulse: int) -> bool:
        """Outputs without a function (SERVOn_FUNCTION 0) are free."""
        pulse = min(max(pulse, 0), LONGEST_US)
        return bool(servos.set_servo(self._v.autopilot.params, self._v.actuators, number - 1, pulse))

    # ------------------------------------------------------------------ GUIDED

    @property
    def _modes(self) -> Modes:
        modes: Modes = self._v.autopilot.modes
        return modes

    def _worded(self, texts: list[str]) -> list[str]:
        """Without GPS in the simple filter (AHRS_GPS_USE 0) there is none to fall back to: the position is missing."""
        if self._vehicle.parameters["AHRS_GPS_USE"] != 0.0:
            return texts
        return [text.replace(TEXTS[AHRS_TYPE], TEXTS[NEED_POSITION]) for text in texts]

    def is_guided_in_auto(self) -> bool:
        """Whether a mission waits for set-points (NAV_GUIDED_ENABLE)."""
        return self.mode() == AUTO and bool(guided_setpoints.is_open(self._modes))

    def guided_position(self, position: Vector) -> bool:
        """Drive to a position; its height means nothing to a rover."""
        return int(guided_setpoints.set_position(self._v, Vec2(position[0], position[1]))) == 0

    def change_speed(self, kind: int, speed: float) -> bool:
        """``speed`` [m/s]; airspeed (0) is ground speed (1), there are no others."""
        return bool(set_mode.change_speed(self._v, speed))

    def change_reposition_speed(self, speed: float) -> bool:
        return self.change_speed(1, speed)

    def set_reversed(self, backward: bool) -> None:
        """Drive paths backwards, until the mode changes."""
        ap = self._v.autopilot
        waypoint.set_reversed(ap.modes.nav, ap.estimate, backward, ap.params)

    # ------------------------------------------------------------------ home

    def set_home_here(self) -> bool:
        return self._report_home(super().set_home_here())

    def set_home(self, lat: int, lon: int, alt: float) -> bool:
        return self._report_home(super().set_home(lat, lon, alt))

    def _report_home(self, ok: bool) -> bool:
        if ok:
            self._say(MavSeverity.INFO, [home.set_text(self._v.autopilot.home)])
        return ok
