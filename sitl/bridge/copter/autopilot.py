# SPDX-License-Identifier: BSD-3-Clause
"""The copter firmware behind the MAVLink services, in one place: a changed law is a changed line here."""

from __future__ import annotations

from collections.abc import Sequence

from ...autopilot import events
from ...autopilot.copter import arming, failsafe, motor_test
from ...autopilot.copter.modes import auto, commands, guided_setpoints, set_mode, table
from ...autopilot.copter.modes.auto_yaw import Turn
from ...autopilot.copter.modes.guided_setpoints import YawSetpoint
from ...autopilot.mission.notes import Text
from ...core.algebra import IDENTITY
from ...core.vectors import Quat, Vec3
from ..autopilot_api import NO_YAW, Note, Vector, Yaw
from ..base_autopilot import CRITICAL, INFO, BaseAutopilot


class CopterAutopilot(BaseAutopilot):
    """The copter firmware's laws, called on the vehicle's record."""

    _arming, _failsafe, _set_mode = arming, failsafe, set_mode
    _auto = auto.AUTO

    def texts_of(self, code: int, a: float, b: float) -> Sequence[Note]:
        if code == events.MOTOR_TEST:
            return [Text(INFO, "starting motor test" if a else "finished motor test")]
        return super().texts_of(code, a, b)

    def start_mission(self) -> bool:
        if not super().start_mission():
            return False
        auto.start_mission(self._v.autopilot.modes.auto, self._v.autopilot.arming)
        return True

    # ------------------------------------------------------------------ take-off and motors

    def takeoff(self, altitude: float) -> bool:
        """Climb to a height above home [m]."""
        return int(commands.take_off(self._v.autopilot, altitude)) == 0

    def test_motor(self, position: int, in_order: bool, throttle: float, seconds: float) -> bool:
        """Turn motor 1 .. at ``throttle`` 0 .. 1; ``in_order``: counted clockwise from the front."""
        motor = position - 1
        if in_order and 0 <= motor < motor_test.MOTORS:
            motor = motor_test.motor_in_order(int(self._v.autopilot.params.FRAME.TYPE), motor)
        answer = int(motor_test.start(self._v, motor, throttle, seconds))
        if answer == motor_test.NOT_LANDED:
            self._say(CRITICAL, ["Motor Test: vehicle not landed"])
        return answer == motor_test.OK

    def set_servo(self, number: int, pulse: int) -> bool:
        """Outputs behind the motors' are free; motors are the mixer's."""
        actuators = self._v.actuators
        if not motor_test.MOTORS < number <= len(actuators.pwm):
            return False
        actuators.pwm[number - 1] = pulse
        actuators.controls[number - 1] = (pulse - 1500) / 500.0
        return True

    def terminate(self) -> None:
        """Stop the motors, in flight too."""
        failsafe.terminate(self._v)

    # ------------------------------------------------------------------ GUIDED

    def guided_position(self, place: Vector, yaw: Yaw | None) -> bool:
        return int(guided_setpoints.set_position(self._v, Vec3(*place), _laws_yaw(yaw))) == 0

    def guided_position_velocity(self, pos: Vector, vel: Vector, acc: Vector, yaw: Yaw) -> bool:
        motion = (Vec3(*pos), Vec3(*vel), Vec3(*acc))
        return int(guided_setpoints.set_pos_vel_accel(self._v, *motion, _laws_yaw(yaw))) == 0

    def guided_velocity(self, vel: Vector, acc: Vector, yaw: Yaw) -> bool:
        return int(guided_setpoints.set_velocity(self._v, Vec3(*vel), Vec3(*acc), _laws_yaw(yaw))) == 0

    def guided_acceleration(self, acc: Vector, yaw: Yaw) -> bool:
        return int(guided_setpoints.set_accel(self._v, Vec3(*acc), _laws_yaw(yaw))) == 0

    def guided_attitude(self, q: tuple[float, ...] | None, rates: Vector, thrust: float) -> bool:
        attitude = IDENTITY if q is None else Quat(*q)
        return int(guided_setpoints.set_attitude(self._v, q is not None, attitude, Vec3(*rates), thrust)) == 0

    def guided_stop(self) -> bool:
        return int(guided_setpoints.stop(self._v)) == 0

    def change_speed(self, kind: int, speed: float) -> bool:
        kinds = (commands.HORIZONTAL, commands.HORIZONTAL, commands.CLIMB, commands.DESCENT)
        if not table.requires_position(self.mode()):
            return False
        if self.mode() == auto.AUTO:
            return bool(self._sequencer().change_speed(self._v, kind, speed))
        ap = self._v.autopilot
        return commands.change_speed(ap.control, ap.params, kinds[kind], speed) == 0

    def condition_yaw(self, angle: float, rate: float, direction: int, relative: bool) -> bool:
        return commands.condition_yaw(self._v.autopilot, Turn(angle, rate, direction, relative)) == 0

    def pause(self, on: bool) -> bool:
        return commands.set_paused(self._v.autopilot.modes, on) == 0

    def set_roi(self, place: Vector | None) -> None:
        if place is None:
            commands.clear_roi(self._v.autopilot)
        else:
            commands.set_roi(self._v.autopilot, Vec3(*place))


def _laws_yaw(yaw: Yaw | None) -> YawSetpoint:
    """Yaw argument of the GUIDED laws: a field that is not used must still be a number."""
    if yaw is None or yaw is NO_YAW:
        return guided_setpoints.NO_YAW
    use_yaw, angle, use_rate, rate, relative = yaw
    return YawSetpoint(use_yaw, angle if use_yaw else 0.0, use_rate, rate if use_rate else 0.0, relative)
