# SPDX-License-Identifier: BSD-3-Clause
"""Many exchanges with a PX4 in one compiled call: the same bytes as one after the other in Python."""

from __future__ import annotations

import math
import socket
from collections.abc import Iterator

import pytest

from sitl.bridge.dialect import message
from sitl.bridge.frame import encode_v2
from sitl.bridge.hil import controls
from sitl.bridge.hil.physics_end import PhysicsEnd
from sitl.bridge.hil.protocol import LOCKSTEP
from sitl.bridge.hil.truth import TRUTH_KIND
from sitl.core.mavlink import MavModeFlag
from sitl.foreign.hil_ticks import HilTicks
from sitl.plants.json_link import wait_in_kernel
from sitl.plants.local import stand_alone
from sitl.plants.physics_server import SimulatedPlant

TICK_US = 2500
BOOTED_US = 4_100_000
"""After that time does not go by the wall clock any more."""
_HEARTBEAT, _COMMAND = message("HEARTBEAT"), message("COMMAND_LONG")


def answer(time_us: int, output: float = 0.4) -> bytes:
    """What PX4 says to a tick."""
    outputs = [output + 0.05 * math.sin(1e-5 * time_us + k) for k in range(4)] + [0.0] * 12
    return encode_v2(controls.KIND, controls.KIND.pack(time_us, LOCKSTEP, *outputs, MavModeFlag.SAFETY_ARMED), 7, 1, 1)


class Px4:
    """A vehicle's physics in a world, and PX4 at its end of the link."""

    def __init__(self) -> None:
        self.plant = stand_alone("erle_copter", world="office_erlecopter", seed=3)
        self.end = PhysicsEnd(SimulatedPlant(self.plant))
        self.end.feed(encode_v2(_HEARTBEAT, _HEARTBEAT.payload(type=2, autopilot=12), 0, 1, 1))
        every = _COMMAND.payload(command=511, param1=TRUTH_KIND.id, param2=5000.0)
        self.end.feed(encode_v2(_COMMAND, every, 1, 1, 1))
        self.end.go_on()
        while self.end.time_us < BOOTED_US:
            self.end.feed(answer(self.time))
        self.ours, self.theirs = socket.socketpair()
        wait_in_kernel(self.ours, 0.05)
        self.ticks = HilTicks(self.plant, self.end)

    @property
    def time(self) -> int:
        """PX4's clock: HIL_SENSOR's [us]."""
        return self.end.time_us

    def exchange(self, said: bytes) -> tuple[bytes, bytes]:
        """An exchange in the compiled call: what it sends, and what it leaves to Python."""
        self.theirs.sendall(said)
        left = self.ticks.go_on(self.ours, self.end.time_us + 100 * TICK_US, 1)
        self.theirs.setblocking(False)
        try:
            return self.theirs.recv(1 << 16), left
        except BlockingIOError:
            return b"", left
        finally:
            self.theirs.setblocking(True)


@pytest.fixture
def pair() -> Iterator[tuple[Px4, Px4]]:
    found = Px4(), Px4()
    if not found[0].ticks.is_quick:
        pytest.skip("Linux and a compiler are needed")
    yield found
    for one in found:
        one.plant.close()
        one.ours.close()
        one.theirs.close()


def test_many_ticks_say_the_same_bytes_as_one_by_one(pair: tuple[Px4, Px4]) -> None:
    """With scans, ranges, GPS fixes, readings of the battery, and the truth at each second tick."""
    quick, slow = pair
    assert quick.end.is_steady
    while quick.end.time_us < 10_500_000:  # the first fix comes at 9.8 s
        said = answer(quick.time)
        assert quick.exchange(said) == (slow.end.feed(said), b"")
        if quick.end.time_us == 5_000_000:  # the other way round: nothing of the state is lost between both
            quick.end.feed(answer(quick.time))
            slow.end.feed(answer(slow.time))
    a, b = quick.plant.vehicle, slow.plant.vehicle
    assert a.fleet[a.index]["physics"].tobytes() == b.fleet[b.index]["physics"].tobytes()
    assert (quick.end.ticks, quick.end.unanswered) == (slow.end.ticks, 0)


def test_what_is_not_the_next_answer_is_pythons(pair: tuple[Px4, Px4]) -> None:
    px4 = pair[0]
    now, before = px4.time, px4.end.time_us
    heartbeat = encode_v2(_HEARTBEAT, _HEARTBEAT.payload(type=2, autopilot=12), 0, 1, 1)
    bad = answer(now)[:-1] + b"\0"
    for said in (heartbeat, answer(now - TICK_US), answer(now) + heartbeat, answer(now)[:30], answer(now, 11.0), bad):
        assert px4.exchange(said) == (b"", said)
    assert px4.end.time_us == before and px4.exchange(b"") == (b"", b"")
    assert px4.exchange(answer(now))[0] and px4.end.time_us == before + TICK_US


def test_it_steps_no_further_than_it_is_told(pair: tuple[Px4, Px4]) -> None:
    px4 = pair[0]
    px4.theirs.sendall(answer(px4.time))
    assert px4.ticks.go_on(px4.ours, px4.end.time_us, 5) == b""
    assert px4.exchange(b"")[0] and px4.end.is_steady
