# SPDX-License-Identifier: BSD-3-Clause
"""What the physics says of itself, and what it answers, as the autopilot's end of HIL hears it."""

from __future__ import annotations

import pytest

from sitl.bridge.dialect import message
from sitl.bridge.hil.autopilot_end import TAKEN, WAITING
from sitl.bridge.hil.protocol import Sender
from tests.bridge.hil.hil_bench import Bench

SENDER = Sender(1, 200)


@pytest.fixture
def bench() -> Bench:
    made = Bench()
    assert made.join() == TAKEN
    made.here.notes.clear()
    return made


def say(bench: Bench, text: bytes) -> int:
    kind = message("STATUSTEXT")
    return bench.here.feed(SENDER.frame(kind, kind.payload(severity=4, text=text)))


@pytest.mark.parametrize(
    ("count", "kept"), [(1, [0]), (5, [0, 1, 2, 3, 4]), (6, [1, 2, 3, 4, 5]), (12, [7, 8, 9, 10, 11])]
)
def test_the_last_five_words_of_the_physics_are_kept(bench: Bench, count: int, kept: list[int]) -> None:
    for k in range(count):
        assert say(bench, b"word %d" % k) == WAITING
    assert bench.here.notes == [f"physics: word {k}" for k in kept]


def test_words_that_are_no_text_are_kept_as_far_as_they_are(bench: Bench) -> None:
    say(bench, b"caf\xe9")
    assert bench.here.notes == ["physics: caf\ufffd"]


def test_words_cost_no_tick(bench: Bench) -> None:
    controls = bench.here.controls()
    say(bench, b"hello")
    assert bench.here.controls() == controls, "the same once more: nothing was answered"
    assert bench.here.feed(bench.there.feed(controls)) == TAKEN
    assert bench.autopilot.v.time_us == 2500
