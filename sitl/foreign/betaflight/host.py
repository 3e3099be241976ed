# SPDX-License-Identifier: BSD-3-Clause
"""A plant and Betaflight's program, a tick at a time: sensors and sticks in, motors out.

Packet k of the motion is that of the end of tick k, and gives the program the time until the end of the next one. When
it has done all that it does in that time, it says so, and the physics does that tick with its motors.
"""

from __future__ import annotations

import struct
from collections.abc import Callable

from ...core.constants import TICK_US
from ...core.geodesy import add_offset
from ...core.record_reader import locate
from ...plants.local import LocalPlant
from ...warp.held_clock import ProgramGone
from . import msp, wire
from .airframe import check
from .face import Face
from .program import Program

_WAIT_S = 0.2
_POLL_US = 100_000
"""Simulated time between two questions for its status [us]."""


class BetaflightHost:
    """See the module.

    Args:
        plant: at power-on.
        start: starts the program; its configuration, or None: as it is kept.
        say: prints a message for the user.

    Raises:
        OptionError: not an airframe for it, or it cannot be started.
    """

    boots = before_boot_us = 0
    """The physics goes on while the program reboots: time is never set back."""

    def __init__(
        self,
        plant: LocalPlant,
        start: Callable[[bytes | None], Program],
        say: Callable[[str], None] = lambda text: None,
    ) -> None:
        self._start, self._say = start, say
        self.attach(plant)
        self.program = start(None)
        self._begin()

    def _begin(self) -> None:
        """The program has just been started."""
        self._answers = msp.Answers()
        self._began_us, self._asked_us = self.time_us, -_POLL_US
        self._is_granted, self._is_done, self._has_begun, self._is_asked = True, False, False, False
        self._sent: tuple[int, ...] = ()

    def attach(self, plant: LocalPlant) -> None:
        """Serve this plant from now on."""
        check(plant.vehicle.airframe)
        self.plant, self.face = plant, Face(plant)
        vehicle = plant.vehicle
        self._clock: Callable[[], int] = vehicle.reader.field("time_us")
        self._sensed = vehicle.reader.fields(
            "sensors.gyro", "sensors.acc", "physics.body.q", "physics.body.vel", "sensors.abs_pressure"
        )
        self._position = vehicle.reader.fields("physics.body.pos")
        self._home = round(1e7 * plant.home[0]), round(1e7 * plant.home[1]), plant.home[2]
        start = vehicle.index * vehicle.fleet.dtype.itemsize
        memory = vehicle.fleet.view("u1").data
        controls_at = start + locate(vehicle.fleet.dtype, "actuators.controls")[0]
        pulses_at = start + locate(vehicle.fleet.dtype, "actuators.pwm")[0]
        controls, pulses = struct.Struct(f"<{wire.MOTORS}f").pack_into, struct.Struct(f"<{wire.MOTORS}q").pack_into

        def put(values: tuple[float, ...]) -> None:
            controls(memory, controls_at, *[min(max(1e-3 * (pulse - wire.IDLE), 0.0), 1.0) for pulse in values])
            pulses(memory, pulses_at, *map(round, values))

        self._put = put

    @property
    def time_us(self) -> int:
        """Simulated time since power-on [us]."""
        return self._clock()

    def listen(self) -> bool:
        """Whether a step can be done; waits up to 0.2 s for what the program has still to do in the last one."""
        return not self._is_granted or self._is_done or self._wait()

    def _wait(self) -> bool:
        """Wait up to 0.2 s until the program has done its step; whether it has."""
        try:
            answer = self.program.clock.answer(_WAIT_S)
        except ProgramGone:
            self._gone()
            return False
        if answer is None:
            return False
        for port, data in answer:
            if port == wire.PULSES:
                self._put(wire.motors(data))
        if self._has_begun:
            self._is_done = True
        else:  # its first word is that it waits for the first step
            self._is_granted, self._has_begun = False, True
        return True

    def _gone(self) -> None:
        """Its command line reboots it by ending: it is started again. A killed one is its owner's matter."""
        if self.program.process.ended(_WAIT_S) != 0:
            return
        kept = self.program.configuration()
        self.program.close()
        self.program = self._start(kept)
        self._begin()
        self._say(f"betaflight reboots at {1e-6 * self.time_us:.1f} s")
        self.face.rebooted()

    def step(self, until_us: int | None = None, answers: int = 1) -> None:
        """Let the program do a tick, then the physics with its motors; nothing, when it does not answer in 0.2 s."""
        if not self._is_granted:
            self._grant()
        if not (self._is_done or (self._wait() and self._is_done)):
            return
        self._is_granted = self._is_done = False
        self.plant.tick()
        now_us = self.time_us
        if self._is_asked:
            self._receive(now_us)
        self.face.tick(now_us)

    def _grant(self) -> None:
        """Give it sticks and motion, and the time until the end of the tick."""
        now_us = self.time_us
        datagrams = [(wire.STATE, self._state(now_us))]
        pulses = self.face.sticks.pulses()
        if pulses != self._sent and self.face.status is not None:  # what comes while it boots is forgotten for good
            datagrams.insert(0, (wire.STICKS, wire.sticks(1e-6 * now_us, pulses)))
            self._sent = pulses
        if now_us - self._asked_us >= _POLL_US:
            self._asked_us, self._is_asked = now_us, True
            numbers = (msp.STATUS_EX,) if self.face.sticks.rates is not None else (msp.STATUS_EX, msp.RC_TUNING)
            self.program.say(b"".join(msp.request(number) for number in numbers))
        self._is_granted = True
        try:
            self.program.clock.grant(now_us + TICK_US - self._began_us, datagrams)
        except ProgramGone:
            self._gone()

    def _state(self, now_us: int) -> bytes:
        """What it gets of the motion: our IMU's and barometer's readings, the true attitude, velocity and position."""
        values = self._sensed()
        north, east, down = self._position()
        lat, lon = add_offset(self._home[0], self._home[1], north, east)
        location = 1e-7 * lat, 1e-7 * lon, self._home[2] - down
        return wire.state(
            1e-6 * now_us, values[:3], values[3:6], values[6:10], values[10:13], location, 100.0 * values[13]
        )

    def _receive(self, now_us: int) -> None:
        for number, payload in self._answers.feed(self.program.receive()):
            if number == msp.STATUS_EX and (status := msp.status(payload)) is not None:
                self._is_asked = self.face.sticks.rates is None
                self.face.receive_status(status, now_us)
            elif number == msp.RC_TUNING and (rates := msp.rates(payload)) is not None:
                self.face.sticks.rates = rates

    def close(self) -> None:
        """End the program; the plant stays open."""
        self.program.close()
