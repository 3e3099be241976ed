# SPDX-License-Identifier: BSD-3-Clause
"""The copter firmware behind the MAVLink services, in one place: a changed law is a changed line here."""

from __future__ import annotations

from typing import Any

from ...autopilot import radio
from ...autopilot.arming_checks import ArmingMethod
from ...autopilot.copter import arming, failsafe, motor_test, parameter_checks
from ...autopilot.copter.control import frames
from ...autopilot.copter.modes import (
    auto,
    ground,
    guided_setpoints,
    mode_commands,
    mode_list,
    payload_place,
    set_mode,
    zigzag,
)
from ...autopilot.copter.modes.acro import ACRO
from ...autopilot.copter.modes.auto_yaw import Turn
from ...autopilot.copter.modes.flip import FLIP
from ...autopilot.copter.modes.guided import GUIDED, GUIDED_NOGPS
from ...autopilot.copter.modes.rtl import RTL as RTL_MODE
from ...autopilot.copter.modes.smart_rtl import SMART_RTL
from ...autopilot.copter.navigation.planner import PLANNER
from ...autopilot.navigation.state import RTL
from ...core.elementary import cos, sin
from ...core.mavlink import MavSeverity
from ...core.scalars import constrain
from ...core.vectors import Vec3
from ..autopilot_api import LONGEST_US, Vector
from ..base_autopilot import BY_GROUND_STATION, BaseAutopilot

LEG_SPEEDS = {"WPNAV_SPEED": "speed_ne", "WPNAV_SPEED_UP": "speed_up", "WPNAV_SPEED_DN": "speed_down"}
"""Parameters, and the speed of a mission (DO_CHANGE_SPEED) that holds instead."""
SPEED_MODES = (auto.AUTO, GUIDED, GUIDED_NOGPS, RTL_MODE, SMART_RTL)
"""In which DO_CHANGE_SPEED is taken."""
FIRST = ("Motors: ", "Interlock/E-Stop Conflict", "Motor Interlock Enabled")
"""Failed checks that are reported alone: the others are not made then."""
LEG_MODES = (auto.AUTO, RTL_MODE, SMART_RTL, zigzag.ZIGZAG)
"""In which a speed of legs acts as soon as it is set."""
FRAME_PARAMETERS = ("FRAME_", "SERVO")


class CopterAutopilot(BaseAutopilot):
    """The copter firmware's laws, called on the vehicle's record."""

    _arming, _set_mode = arming, set_mode
    _auto = auto.AUTO
    _block_order = mode_list.GCS_BLOCK
    _checks = parameter_checks.CHECKS

    def __init__(self, vehicle: Any) -> None:
        super().__init__(vehicle)
        self._check_frame()

    def _check_frame(self) -> None:
        """Warn of a frame that is not the airframe's: the vehicle would tip over."""
        motors, rotors = int(self._v.autopilot.control.motors.count), int(self._v.physics.airframe.rotor_count)
        if motors not in (0, rotors):
            number = self._v.autopilot.params.FRAME.CLASS
            self._say(
                MavSeverity.WARNING, [f"FRAME_CLASS {number:.0f} has {motors} motors, this vehicle {rotors} rotors"]
            )

    def _worded(self, texts: list[str]) -> list[str]:
        first = [text for text in texts if any(each in text for each in FIRST)]
        return first or texts

    def start_mission(self) -> bool:
        if self._v.autopilot.modes.shown == auto.AUTO_RTL and not self.set_mode(auto.AUTO):
            return False
        if not super().start_mission():
            return False
        auto.start_mission(self._v.autopilot.modes.auto, self._v.autopilot.arming)
        return True

    def go_back(self, how: int) -> bool:
        """AUTO_RTL by a return path (BY_PATH) or a landing sequence (BY_LANDING)."""
        if self.mode() != auto.AUTO and self._is_blocked(auto.AUTO):
            return False
        return int(set_mode.go_back(self._v, how, BY_GROUND_STATION)) == 0

    # ------------------------------------------------------------------ take-off and motors

    def takeoff(self, altitude: float) -> bool:
        """Climb to a height above home [m]."""
        return int(mode_commands.take_off(self._v.autopilot, altitude)) == 0

    def test_motor(self, position: int, in_order: bool, throttle: float, seconds: float) -> bool:
        """Turn motor 1 .. at ``throttle`` 0 .. 1; ``in_order``: counted clockwise from the front.

        Only a vehicle that flies refuses it. A test of a motor that is not there, or at a throttle that is none, ends
        as it begins.
        """
        motor = position - 1
        order = frames.order(self._v.autopilot.params)
        if in_order and 0 <= motor < len(order):
            motor = order[motor]
        answer = int(motor_test.start(self._v, motor, throttle, seconds))
        if answer == motor_test.NOT_LANDED:
            self._say(MavSeverity.CRITICAL, ["Motor Test: vehicle not landed"])
            return False
        if answer != motor_test.OK:
            began = [] if self.is_testing_motor() else ["starting motor test"]
            cancelled = ["Motor Test: cancelled"] if answer == motor_test.BAD_MOTOR else []
            self._say(
                MavSeverity.INFO, [*began, *cancelled, *([] if self.is_testing_motor() else ["finished motor test"])]
            )
            motor_test.end(self._v)
        return True

    def is_testing_motor(self) -> bool:
        """Whether a motor test is under way."""
        return int(self._v.autopilot.control.motors.test_motor) != 0

    def rest_tested_motor(self) -> None:
        """No throttle for the motor under test; the test goes on."""
        self._v.autopilot.control.motors.test_actuator = 0.0

    def throttle_pulse(self) -> int:
        """Of the throttle stick [us]."""
        ap = self._v.autopilot
        return int(ap.rc.channels[radio.stick_channel(ap.params.RCMAP, radio.THROTTLE)])

    def set_servo(self, number: int, pulse: int) -> bool:
        """Outputs without a motor are free; no pulse (0) is a control of 0."""
        actuators, motors = self._v.actuators, self._v.autopilot.control.motors
        if not 0 < number <= len(actuators.pwm) or number - 1 in motors.output[: motors.count]:
            return False
        actuators.pwm[number - 1] = pulse = min(max(pulse, 0), LONGEST_US)
        actuators.controls[number - 1] = constrain((pulse - 1500) / 500.0, -1.0, 1.0) if pulse != 0 else 0.0
        return True

    def terminate(self) -> None:
        """Stop the motors, in flight too."""
        failsafe.terminate(self._v)

    # ------------------------------------------------------------------ gripper, parachute

    def gripper_is(self, there: bool, is_open: bool) -> None:
        grip = payload_place.HOLDS if there else payload_place.NO_GRIPPER
        self._v.autopilot.modes.payload_place.gripper = payload_place.OPEN if there and is_open else grip

    def is_landed(self) -> bool:
        return bool(self._v.autopilot.arming.landed)

    def height(self) -> float:
        """Above home [m]."""
        ap = self._v.autopilot
        return float(ap.home.pos.z - ap.estimate.pos.z)

    def sink_rate(self) -> float:
        """[m/s]."""
        return float(self._v.autopilot.estimate.vel.z)

    def lean_error(self) -> float:
        """How far the thrust is from where it should point [rad]; 0 in modes that turn over on purpose."""
        turns_over = self.mode() in (ACRO, FLIP)
        return 0.0 if turns_over else float(self._v.autopilot.control.attitude.thrust_error_angle)

    def release_parachute(self, stop_motors: bool) -> None:
        """Note that it is released: the vehicle is not armed again before the next boot."""
        self._v.autopilot.arming.parachute_released = True
        if stop_motors:
            ground.disarm(self._v, ArmingMethod.PARACHUTE)

    # ------------------------------------------------------------------ GUIDED

    def guided_position(self, position: Vector) -> bool:
        return int(guided_setpoints.set_position(self._v, Vec3(*position), guided_setpoints.NO_YAW)) == 0

    def change_speed(self, kind: int, speed: float) -> bool:
        """SPEED_TYPE of MAVLink, ``speed`` [m/s]; refused in modes that fly to no position."""
        kinds = (mode_commands.HORIZONTAL, mode_commands.HORIZONTAL, mode_commands.CLIMB, mode_commands.DESCENT)
        if self.mode() not in SPEED_MODES or not 0 <= kind < len(kinds):
            return False
        if self.mode() == auto.AUTO:
            return bool(self._sequencer().change_speed(self._v, kind, speed))
        ap = self._v.autopilot
        return mode_commands.change_speed(ap.control, ap.params, kinds[kind], speed) == 0

    def parameter_changed(self, name: str) -> None:
        """A frame that is set while disarmed holds at once; speeds of legs that are set while a leg is flown hold from
        there on, whatever the mission said before. On the way home RTL_SPEED comes before WPNAV_SPEED."""
        if name.startswith(FRAME_PARAMETERS) and not self.armed():
            is_frame = name.startswith(FRAME_PARAMETERS[0])  # an output that loses its function does not get it back
            frames.load_frame(self._v.autopilot.control.motors, self._v.autopilot.params, is_frame)
            self._check_frame()
        super().parameter_changed(name)
        nav, mode, field = self._v.autopilot.modes.nav, self.mode(), LEG_SPEEDS.get(name)
        if field is None or mode not in LEG_MODES:
            return
        goes_home = mode == RTL_MODE or (mode == auto.AUTO and nav.command_kind == RTL)
        if not (goes_home and name == "WPNAV_SPEED" and self._v.autopilot.params.RTL.SPEED > 0.0):
            setattr(nav, field, 0.0)
            PLANNER.change_speed(self._v.autopilot)

    def yaw_rate_target(self) -> float:
        if self._v.autopilot.arming.landed:
            return 0.0
        attitude = self._v.autopilot.control.attitude
        rate, target = attitude.target_rate, attitude.target_euler
        return float((sin(target.roll) * rate.y + cos(target.roll) * rate.z) / max(cos(target.pitch), 1e-3))

    def condition_yaw(self, angle: float, rate: float, direction: int, relative: bool) -> bool:
        """Turn to ``angle`` [rad] at ``rate`` [rad/s]; ``direction`` 1 clockwise, -1 the other way, 0 the shorter."""
        return mode_commands.condition_yaw(self._v.autopilot, Turn(angle, rate, direction, relative)) == 0

    def pause(self, on: bool) -> bool:
        done = mode_commands.set_paused(self._v.autopilot.modes, on) == 0
        if not done:
            self._say(MavSeverity.INFO, ["Failed to pause" if on else "Failed to resume"])
        return done

    def set_roi(self, position: Vector | None) -> None:
        if position is None:
            mode_commands.clear_roi(self._v.autopilot)
        else:
            mode_commands.set_roi(self._v.autopilot, Vec3(*position))
