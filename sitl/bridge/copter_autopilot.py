# SPDX-License-Identifier: BSD-3-Clause
"""The copter firmware behind the MAVLink services, in one place: a changed law is a changed line here."""

from __future__ import annotations

from typing import Any

from ..autopilot import events
from ..autopilot.mission.item import MissionItem, home_item
from ..autopilot.mission.mission import Mission
from ..autopilot.mission.notes import Text
from ..autopilot.mission.validate import check_all
from ..autopilot.navigation.state import RUNNING
from ..core.records import view
from .autopilot_api import NO_YAW, Note, Vector, Yaw
from .vehicle import Vehicle

CRITICAL, WARNING, INFO = 2, 4, 6
"""MAV_SEVERITY"""
BY_MAVLINK = 1
"""Method of arming and disarming (ArduPilot's number)."""
BY_GROUND_STATION = 2
"""Reason of a mode change (ArduPilot's number)."""
AUTO = 3


class CopterAutopilot:
    """The copter firmware's laws, called on the vehicle's record."""

    def __init__(self, vehicle: Any) -> None:
        # the flight code is loaded with the first vehicle, not with the bridge: its tests need none of it
        from ..autopilot import arming, failsafe, home, motor_test
        from ..autopilot.estimation import origin
        from ..autopilot.modes.copter import auto, guided, numbers, set_mode, takeoff

        self._arming, self._guided, self._takeoff = arming, guided, takeoff
        self._set_mode, self._numbers, self._auto = set_mode, numbers, auto
        self._home, self._failsafe = home, failsafe
        self._motor_test, self._origin = motor_test, origin
        self._vehicle: Vehicle = vehicle
        self._v = view(vehicle.fleet, vehicle.index)
        self._sequencer = lambda: vehicle.sequencer
        self._notes: list[Note] = []

    def take_notes(self) -> list[Note]:
        """What there is to tell, once."""
        notes, self._notes = self._notes, []
        return notes

    def texts_of(self, code: int, a: int, b: int) -> list[Text]:
        """Texts of an event of the core that only the flight code can word; none for most."""
        if code == events.MODE_REFUSED:
            return [Text(WARNING, text) for text in self._numbers.refusal_texts(a, b)]
        if code == events.ARMING_REFUSED and b != BY_MAVLINK:  # arm() has given those already
            return [Text(CRITICAL, text) for text in self._arming.texts(a, "Arm: ")]
        if code == events.FAILSAFE:
            text = self._failsafe.text(a, bool(b))
            return [Text(WARNING, text)] if text else []
        if code == events.MOTOR_TEST:
            return [Text(INFO, "starting motor test" if a else "finished motor test")]
        return []

    def _say(self, severity: int, texts: list[str]) -> None:
        self._notes.extend(Text(severity, text) for text in texts)

    # ------------------------------------------------------------------ arming and modes

    def armed(self) -> bool:
        return bool(self._v.autopilot.arming.armed)

    def mode(self) -> int:
        return int(self._v.autopilot.modes.number)

    def arm(self, force: bool) -> bool:
        ok, texts = self._arming.arm(self._v, BY_MAVLINK, force)
        self._say(CRITICAL, texts)
        return bool(ok)

    def disarm(self, force: bool) -> bool:
        return bool(self._arming.disarm(self._v, BY_MAVLINK, int(force)))

    def run_prearm_checks(self) -> None:
        self._say(CRITICAL, self._arming.texts(self._arming.check(self._v), "PreArm: "))

    def set_mode(self, number: int) -> bool:
        return int(self._set_mode.request(self._v, number, BY_GROUND_STATION)) == 0  # refusals are events

    def takeoff(self, altitude: float) -> bool:
        return int(self._takeoff.start(self._v, altitude)) == 0

    def test_motor(self, position: int, in_order: bool, throttle: float, seconds: float) -> bool:
        motor = position - 1
        if in_order and 0 <= motor < self._motor_test.MOTORS:
            motor = self._motor_test.motor_in_order(int(self._v.autopilot.params.FRAME_TYPE), motor)
        answer = int(self._motor_test.start(self._v, motor, throttle, seconds))
        if answer == self._motor_test.NOT_LANDED:
            self._say(CRITICAL, ["Motor Test: vehicle not landed"])
        return answer == self._motor_test.OK

    def set_servo(self, number: int, pulse: int) -> bool:
        """Outputs behind the motors' are free; motors are the mixer's."""
        actuators = self._v.actuators
        if not self._motor_test.MOTORS < number <= len(actuators.pwm):
            return False
        actuators.pwm[number - 1] = pulse
        actuators.controls[number - 1] = (pulse - 1500) / 500.0
        return True

    def terminate(self) -> None:
        self._failsafe.terminate(self._v)

    # ------------------------------------------------------------------ GUIDED

    def guided_position(self, place: Vector, yaw: Yaw | None) -> bool:
        return int(self._guided.set_position(self._v, *place, *_laws_yaw(yaw))) == 0

    def guided_position_velocity(self, pos: Vector, vel: Vector, acc: Vector, yaw: Yaw) -> bool:
        return int(self._guided.set_pos_vel_accel(self._v, *pos, *vel, *acc, *_laws_yaw(yaw))) == 0

    def guided_velocity(self, vel: Vector, acc: Vector, yaw: Yaw) -> bool:
        return int(self._guided.set_velocity_accel(self._v, *vel, *acc, *_laws_yaw(yaw))) == 0

    def guided_acceleration(self, acc: Vector, yaw: Yaw) -> bool:
        return int(self._guided.set_accel(self._v, *acc, *_laws_yaw(yaw))) == 0

    def guided_attitude(self, q: tuple[float, ...] | None, rates: Vector, thrust: float) -> bool:
        w, x, y, z = q or (1.0, 0.0, 0.0, 0.0)
        return int(self._guided.set_attitude(self._v, int(q is not None), w, x, y, z, *rates, thrust)) == 0

    def guided_stop(self) -> bool:
        return int(self._guided.stop(self._v)) == 0

    def change_speed(self, kind: int, speed: float) -> bool:
        kinds = (self._guided.HORIZONTAL, self._guided.HORIZONTAL, self._guided.CLIMB, self._guided.DESCENT)
        if not self._numbers.requires_position(self.mode()):
            return False
        if self.mode() == AUTO:
            return bool(self._sequencer().change_speed(self._v, kind, speed))
        return int(self._guided.change_speed(self._v, kinds[kind], speed)) == 0

    def condition_yaw(self, angle: float, rate: float, direction: int, relative: bool) -> bool:
        return int(self._guided.condition_yaw(self._v, angle, rate, direction, int(relative))) == 0

    def pause(self, on: bool) -> bool:
        return int((self._guided.pause if on else self._guided.resume)(self._v)) == 0

    def set_roi(self, place: Vector | None) -> None:
        if place is None:
            self._guided.clear_roi(self._v)
        else:
            self._guided.set_roi(self._v, *place)

    # ------------------------------------------------------------------ home, origin, parameters

    def set_home_here(self) -> bool:
        if not self._v.autopilot.estimate.position_ok or not self._home.set_here(self._v):
            return False
        self._v.autopilot.home.locked = 1
        return True

    def set_home(self, lat: int, lon: int, alt: float) -> bool:
        return bool(self._home.set_place(self._v, lat, lon, alt, 1))

    def set_origin(self, lat: int, lon: int, alt: float) -> bool:
        return int(self._origin.set_origin(self._v.autopilot, lat, lon, alt)) == 1

    def parameter_changed(self, name: str) -> None:
        changed = getattr(self._vehicle, "parameter_changed", None)
        if changed is not None:
            changed(name)

    # ------------------------------------------------------------------ mission

    def mission_items(self) -> tuple[MissionItem, ...]:
        items = tuple(self._sequencer().mission.items)
        home = self._v.autopilot.home
        if not items or not home.is_set:
            return items
        return (home_item(int(home.lat), int(home.lon), float(home.alt)), *items[1:])

    def current_item(self) -> int:
        return int(self._v.autopilot.modes.nav.mission_current)

    def replace_mission(self, items: tuple[MissionItem, ...]) -> int:
        result, _ = check_all(items)
        if result == 0:
            self._notes.extend(self._sequencer().set_mission(self._v, Mission(items)))
        return int(result)

    def clear_mission(self) -> bool:
        if not self._sequencer().may_clear(self._v):
            return False
        self._notes.extend(self._sequencer().set_mission(self._v, Mission()))
        return True

    def set_current_item(self, seq: int, reset: bool) -> bool:
        if reset:
            self._notes.extend(self._sequencer().reset(self._v))
        if seq == -1:
            return reset
        ok, notes = self._sequencer().set_current(self._v, seq)
        self._notes.extend(notes)
        return bool(ok)

    def start_mission(self) -> bool:
        nav = self._v.autopilot.modes.nav
        if self.mode() != AUTO:
            if not self.set_mode(AUTO):
                return False  # what enters AUTO starts the mission: MODE_CHANGED reaches the sequencer
        elif nav.mission_state != RUNNING:
            if not self._sequencer().mission.present:
                return False
            self._notes.extend(self._sequencer().start(self._v))
        self._auto.start(self._v)
        return True


def _laws_yaw(yaw: Yaw | None) -> tuple[int, float, int, float, int]:
    """Yaw arguments of the GUIDED laws: a field that is not used must still be a number."""
    if yaw is None or yaw is NO_YAW:
        return (0, 0.0, 0, 0.0, 0)
    use_yaw, angle, use_rate, rate, relative = yaw
    return (int(use_yaw), angle if use_yaw else 0.0, int(use_rate), rate if use_rate else 0.0, int(relative))
