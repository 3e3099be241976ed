# SPDX-License-Identifier: BSD-3-Clause
"""MAVLink for a Betaflight: commands become sticks and switches, and its status becomes answers and texts.

It is never forced: it arms when Betaflight does, with the throttle low, and in the air it is disarmed only by force.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import Any

from ...bridge.dialect import MessageType, message, message_by_id
from ...bridge.frame import Splitter, encode_v2
from ...bridge.services.setpoint_messages import ATTITUDE_IGNORED
from ...core.mavlink import ARM_FORCED, MavAutopilot, MavCmd, MavModeFlag, MavResult, MavSeverity, MavState, MavType
from ...plants.local import LocalPlant
from .airframe import throttle
from .msp import Status
from .receiver import ACRO, MODES, Sticks
from .sim_parameters import SimParameters
from .true_telemetry import Telemetry

SYSTEM, COMPONENT = 1, 1
ARM_US = 500_000
"""Simulated time that Betaflight has to do what the arm switch says [us]."""
SECOND_US, SHORTEST_US = 1_000_000, 2500
DEFAULT_US = {
    "ATTITUDE": 100_000, "LOCAL_POSITION_NED": 100_000, "GLOBAL_POSITION_INT": 200_000, "VFR_HUD": 200_000,
    "GPS_RAW_INT": 500_000, "RC_CHANNELS": 500_000, "SERVO_OUTPUT_RAW": 500_000, "SYS_STATUS": SECOND_US,
    "BATTERY_STATUS": SECOND_US, "EXTENDED_SYS_STATE": SECOND_US,
}  # fmt: skip
"""What is sent before a client asks for something else, and how often [us]."""
HEARTBEAT = message("HEARTBEAT")


def _whole(value: float) -> int:
    """A parameter that is a whole number; -2, which means nothing, when it is no number."""
    return int(value) if math.isfinite(value) else -2


class Face:
    """See the module.

    Args:
        plant: the physics.
    """

    def __init__(self, plant: LocalPlant) -> None:
        self.sticks = Sticks()
        self.telemetry = Telemetry(plant, self.sticks)
        self.status: Status | None = None
        """What Betaflight said last."""
        self.send: Callable[[bytes], None] = lambda frame: None
        """Takes each frame for the clients."""
        self._parameters = SimParameters(plant, self._frame)
        self._motors = plant.vehicle.v.autopilot.params.MOT
        self._splitter, self._sequence, self._now_us = Splitter(), 0, 0
        self._intervals = {HEARTBEAT.id: SECOND_US} | {message(n).id: us for n, us in DEFAULT_US.items()}
        self._due = dict.fromkeys(self._intervals, 0)
        self._next_us = 0
        self._pending: tuple[bool, int, tuple[int, int]] | None = None
        """Whether it is to be armed, until when, who asked."""
        self._was_armed = False
        self._builders = {HEARTBEAT.id: self._heartbeat, **self.telemetry.builders}
        self._handlers: dict[str, Callable[[Any, tuple[int, int]], None]] = {
            "COMMAND_LONG": self._command,
            "COMMAND_INT": self._command_int,
            "RC_CHANNELS_OVERRIDE": lambda m, sender: self.sticks.override(m),
            "MANUAL_CONTROL": lambda m, sender: self.sticks.manual(m),
            "SET_ATTITUDE_TARGET": self._attitude_target,
            "SET_MODE": self._old_set_mode,
            "REQUEST_DATA_STREAM": self._data_stream,
            "PARAM_REQUEST_READ": lambda m, sender: self._parameters.read(m),
            "PARAM_REQUEST_LIST": lambda m, sender: self._parameters.list(),
            "PARAM_SET": lambda m, sender: self._parameters.set(m),
        }

    # ------------------------------------------------------------------ time

    @property
    def is_armed(self) -> bool:
        """Whether Betaflight says so."""
        return self.status is not None and self.status.armed

    def tick(self, now_us: int) -> None:
        """Send what is due."""
        self._now_us = now_us
        if now_us < self._next_us:
            return
        for number, due_us in self._due.items():
            if due_us <= now_us:
                self._send_now(number)
                interval = self._intervals[number]
                self._due[number] = now_us - now_us % interval + interval
        self._next_us = min(self._due.values())

    def receive_status(self, status: Status, now_us: int) -> None:
        """Betaflight has said how it is."""
        self.status = status
        self.telemetry.may_arm = status.armed or not status.arming
        if status.armed != self._was_armed:
            self._was_armed = status.armed
            if not status.armed and self._pending is None and self.sticks.is_armed:
                self.sticks.is_armed = False  # it must see the switch off before it arms again
                self.say(MavSeverity.WARNING, f"Disarmed by Betaflight: {status.reasons or 'no reason told'}")
            self.say(MavSeverity.INFO, "Armed" if status.armed else "Disarmed")
            self._send_now(HEARTBEAT.id)
        if self._pending is not None:
            self._settle(status, now_us)

    def rebooted(self) -> None:
        """Betaflight has begun anew."""
        self.status, self.sticks.is_armed, self._pending = None, False, None
        self.say(MavSeverity.WARNING, "Betaflight has rebooted")

    # ------------------------------------------------------------------ what goes out

    def say(self, severity: int, text: str) -> None:
        """A STATUSTEXT."""
        kind = message("STATUSTEXT")
        for at in range(0, max(len(text), 1), 50):
            self._frame(kind, kind.payload(severity=severity, text=text[at : at + 50].encode("ascii", "replace")))

    def _frame(self, kind: MessageType, payload: bytes) -> None:
        self.send(encode_v2(kind, payload, self._sequence, SYSTEM, COMPONENT))
        self._sequence = (self._sequence + 1) & 0xFF

    def _send_now(self, number: int) -> None:
        self._frame(message_by_id(number), self._builders[number]())

    def _heartbeat(self) -> bytes:
        armed = MavModeFlag.SAFETY_ARMED if self.is_armed else 0
        return HEARTBEAT.payload(
            type=MavType.QUADROTOR, autopilot=MavAutopilot.GENERIC, base_mode=MavModeFlag.CUSTOM_MODE_ENABLED | armed,
            custom_mode=self.sticks.mode.number, system_status=MavState.ACTIVE if self.is_armed else MavState.STANDBY,
            mavlink_version=3,
        )  # fmt: skip

    # ------------------------------------------------------------------ what comes in

    def feed(self, data: bytes) -> None:
        """Bytes of a client, in any pieces."""
        for frame in self._splitter.feed(data):
            handler = self._handlers.get(frame.kind.name)
            if handler is None:
                continue
            fields = frame.kind.decode(frame.payload)
            target = getattr(fields, "target_system", getattr(fields, "target", SYSTEM))
            if target in (0, SYSTEM):
                handler(fields, (frame.system, frame.component))

    def _attitude_target(self, m: Any, sender: tuple[int, int]) -> None:
        """Rates of the body and a thrust: in ACRO, whose sticks are rates."""
        rates = m.body_roll_rate, m.body_pitch_rate, m.body_yaw_rate
        are_numbers = all(map(math.isfinite, (*rates, m.thrust)))
        if self.sticks.mode is ACRO and m.type_mask & ATTITUDE_IGNORED and are_numbers:
            self.sticks.turn(rates, throttle(m.thrust, self._motors))

    def _data_stream(self, m: Any, sender: tuple[int, int]) -> None:
        """All streams at a rate, or none: HEARTBEAT goes on."""
        rate = m.req_message_rate if m.start_stop == 1 else 0
        for name in DEFAULT_US:
            self._set_interval(message(name).id, max(SECOND_US // rate, SHORTEST_US) if rate > 0 else 0)

    def _set_interval(self, number: int, interval_us: int) -> None:
        if interval_us <= 0:
            self._intervals.pop(number, None)
            self._due.pop(number, None)
        else:
            self._intervals[number] = interval_us
            self._due[number] = self._now_us - self._now_us % interval_us + interval_us
        self._next_us = min(self._due.values())

    # ------------------------------------------------------------------ commands

    def _command_int(self, m: Any, sender: tuple[int, int]) -> None:
        self._answer(m.command, MavResult.UNSUPPORTED, sender)

    def _command(self, m: Any, sender: tuple[int, int]) -> None:
        if m.command == MavCmd.COMPONENT_ARM_DISARM:
            self._arm(m.param1 == 1.0, m.param2 == ARM_FORCED, sender)
            return
        results = {
            MavCmd.DO_SET_MODE: self._do_set_mode,
            MavCmd.SET_MESSAGE_INTERVAL: self._message_interval,
            MavCmd.REQUEST_MESSAGE: self._request,
        }
        found = results.get(m.command)
        self._answer(m.command, MavResult.UNSUPPORTED if found is None else found(m), sender)

    def _answer(self, command: int, result: int, to: tuple[int, int]) -> None:
        kind = message("COMMAND_ACK")
        self._frame(kind, kind.payload(command=command, result=result, target_system=to[0], target_component=to[1]))

    def _do_set_mode(self, m: Any) -> int:
        if _whole(m.param1) & MavModeFlag.CUSTOM_MODE_ENABLED:
            return self._set_mode(_whole(m.param2))
        self.say(MavSeverity.WARNING, "Mode: MAV_MODE_FLAG_CUSTOM_MODE_ENABLED is needed")
        return MavResult.DENIED

    def _set_mode(self, number: int) -> int:
        for mode in MODES:
            if mode.number == number:
                self.sticks.mode = mode
                self._send_now(HEARTBEAT.id)
                return MavResult.ACCEPTED
        known = ", ".join(f"{mode.number} {mode.name}" for mode in MODES)
        self.say(MavSeverity.WARNING, f"No mode {number}; there are {known}")
        return MavResult.DENIED

    def _old_set_mode(self, m: Any, sender: tuple[int, int]) -> None:
        """SET_MODE, which has no answer."""
        self._set_mode(m.custom_mode)

    def _message_interval(self, m: Any) -> int:
        number, interval = _whole(m.param1), _whole(m.param2)
        if number not in self._builders or interval < -1 or 0 < interval < SHORTEST_US:
            return MavResult.DENIED
        names = {message(name).id: us for name, us in DEFAULT_US.items()}
        self._set_interval(number, names.get(number, 0) if interval == 0 else interval)
        return MavResult.ACCEPTED

    def _request(self, m: Any) -> int:
        number = _whole(m.param1)
        if number == message("AVAILABLE_MODES").id:
            return self._send_modes(_whole(m.param2))
        if number not in self._builders:
            return MavResult.DENIED
        self._send_now(number)
        return MavResult.ACCEPTED

    def _send_modes(self, index: int) -> int:
        kind = message("AVAILABLE_MODES")
        for k, mode in enumerate(MODES, start=1):
            if index in (0, k):
                name = mode.name.encode()
                self._frame(kind, kind.payload(number_modes=len(MODES), mode_index=k, custom_mode=mode.number,
                                               mode_name=name))  # fmt: skip
        return MavResult.ACCEPTED if 0 <= index <= len(MODES) else MavResult.DENIED

    def _arm(self, wanted: bool, by_force: bool, sender: tuple[int, int]) -> None:
        status = self.status
        if status is None:
            self._refuse(MavResult.TEMPORARILY_REJECTED, "Betaflight has not told its status yet", sender)
        elif self._pending is not None:
            self._refuse(MavResult.TEMPORARILY_REJECTED, "the last command is still being carried out", sender)
        elif status.armed == wanted:
            self._answer(MavCmd.COMPONENT_ARM_DISARM, MavResult.ACCEPTED, sender)
        elif not wanted and not (by_force or self.telemetry.is_on_ground):
            self._refuse(MavResult.DENIED, "not in the air (param2 21196 does)", sender, "Disarm")
        elif wanted and not self.sticks.throttle_is_low:
            self._refuse(MavResult.DENIED, "the throttle is not low (1050 us)", sender)
        elif wanted and status.arming:
            self._refuse(MavResult.DENIED, status.reasons, sender)
        else:
            self.sticks.is_armed = wanted
            self._pending = wanted, self._now_us + ARM_US, sender

    def _refuse(self, result: int, why: str, sender: tuple[int, int], what: str = "Arm") -> None:
        self.say(MavSeverity.WARNING, f"{what}: {why}")
        self._answer(MavCmd.COMPONENT_ARM_DISARM, result, sender)

    def _settle(self, status: Status, now_us: int) -> None:
        """Whether what was asked for has come true, or time is up."""
        assert self._pending is not None
        wanted, until_us, sender = self._pending
        if status.armed == wanted:
            self._pending = None
            self._answer(MavCmd.COMPONENT_ARM_DISARM, MavResult.ACCEPTED, sender)
        elif now_us >= until_us:
            self._pending = None
            self.sticks.is_armed = status.armed
            self._refuse(
                MavResult.FAILED, status.reasons or "Betaflight does not say why", sender, "Arm" if wanted else "Disarm"
            )
