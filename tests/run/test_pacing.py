# SPDX-License-Identifier: BSD-3-Clause
"""Pacing against a clock that the test moves."""

from __future__ import annotations

import pytest

from sitl.run.pacing import Pacing, SpeedupError, parse_speedup


class Clock:
    """A wall clock in the test's hand."""

    now = 100.0

    def __call__(self) -> float:
        return self.now


def test_waits_make_the_speedup() -> None:
    clock = Clock()
    pacing = Pacing(5.0, clock)
    start, simulated = clock.now, 0
    for _ in range(1000):
        simulated += pacing.slice_us
        clock.now += pacing.wait_s()
    assert simulated * 1e-6 / (clock.now - start) == pytest.approx(5.0)


def test_a_short_delay_is_caught_up_and_a_long_one_is_not() -> None:
    for delay, lost in ((0.03, 0.0), (2.0, 1.95)):
        clock = Clock()
        pacing = Pacing(1.0, clock)
        start, simulated = clock.now, 0
        for k in range(1000):
            simulated += pacing.slice_us
            clock.now += pacing.wait_s() + (delay if k == 500 else 0.0)
        assert clock.now - start - simulated * 1e-6 == pytest.approx(lost, abs=0.01)


def test_max_never_waits() -> None:
    pacing = Pacing(None, Clock())
    assert [pacing.wait_s() for _ in range(5)] == [0.0] * 5


@pytest.mark.parametrize("text", ["0", "-1", "nan", "inf", "fast", "", "1e9"])
def test_refuses_what_is_not_a_speedup(text: str) -> None:
    with pytest.raises(SpeedupError, match="speed-up"):
        parse_speedup(text)


def test_reads_speedups() -> None:
    assert parse_speedup("20") == 20.0
    assert parse_speedup("0.5") == 0.5
    assert parse_speedup("max") is None


def test_a_busy_client_is_answered_and_does_not_hurry_the_clock() -> None:
    clock = Clock()

    class Busy:
        """A bridge whose sockets always have something to read, after a tenth of a millisecond."""

        answered = 0

        def wait(self, seconds: float) -> bool:
            clock.now += min(1e-4, seconds)
            return True

        def receive(self) -> None:
            self.answered += 1

    class Vehicle:
        bridge = Busy()

    pacing, vehicle = Pacing(1.0, clock), Vehicle()
    start = clock.now
    for _ in range(100):
        pacing.after_slice(vehicle)  # type: ignore[arg-type]
    assert clock.now - start == pytest.approx(100 * pacing.slice_us * 1e-6, rel=0.01)
    assert vehicle.bridge.answered > 1000
