# SPDX-License-Identifier: BSD-3-Clause
"""How far simulated time goes between two looks at clients and clock, and how long it waits."""

from __future__ import annotations

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from sitl.core.constants import TICK_US
from sitl.run.pacing import FASTEST, LONGEST_QUIET_US, SLOWEST, Pacing, SpeedupError, parse_speedup


class Clock:
    """A wall clock in the test's hand."""

    now = 100.0

    def __call__(self) -> float:
        return self.now


class Silent:
    """A bridge whose clients say nothing."""

    received = 0

    def __init__(self, clock: Clock) -> None:
        self._clock = clock

    def wait(self, seconds: float) -> bool:
        self._clock.now += seconds
        return False

    def receive(self) -> None: ...


class Vehicle:
    """Advances by whole ticks, as a simulation does."""

    time_us = 0

    def __init__(self, clock: Clock) -> None:
        self.bridge = Silent(clock)

    def advance_to(self, time_us: int) -> None:
        self.time_us += max(-(-(time_us - self.time_us) // TICK_US), 0) * TICK_US


def flown(pacing: Pacing, clock: Clock, seconds: float, step_us: int = 1 << 62) -> float:
    """Wall time [s] that it takes to fly so long, by steps that a caller may not go beyond."""
    vehicle, start = Vehicle(clock), clock.now
    while vehicle.time_us < seconds * 1e6:
        end = min((vehicle.time_us // step_us + 1) * step_us, round(seconds * 1e6))
        vehicle.advance_to(min(vehicle.time_us + pacing.slice_us, end))
        pacing.after_slice(vehicle)  # type: ignore[arg-type]
    return clock.now - start


@pytest.mark.parametrize("speedup", [0.5, 1.0, 3.0, 5.0, 17.0, 60.0, 1000.0])
@pytest.mark.parametrize("step_us", [1 << 62, 100_000])
def test_waits_make_the_speedup(speedup: float, step_us: int) -> None:
    clock = Clock()
    assert flown(Pacing(speedup, clock), clock, 20.0, step_us) == pytest.approx(20.0 / speedup, rel=0.01)


def test_a_short_delay_is_caught_up_and_a_long_one_is_not() -> None:
    for delay, lost in ((0.03, 0.0), (2.0, 1.95)):
        clock = Clock()
        pacing = Pacing(1.0, clock)
        start, simulated = clock.now, 0
        for k in range(1000):
            simulated += pacing.slice_us
            clock.now += pacing.wait_s(pacing.slice_us) + (delay if k == 500 else 0.0)
        assert clock.now - start - simulated * 1e-6 == pytest.approx(lost, abs=0.01)


def test_max_never_waits() -> None:
    pacing = Pacing(None, Clock())
    assert [pacing.wait_s(20_000) for _ in range(5)] == [0.0] * 5


@pytest.mark.parametrize("text", ["0", "-1", "nan", "inf", "fast", "", "1e9", "1e-9"])
def test_refuses_what_is_not_a_speedup(text: str) -> None:
    with pytest.raises(SpeedupError, match=r"from 0\.001 to 100000 or 'max'"):
        parse_speedup(text)


@pytest.mark.parametrize("speedup", [0.0, -1.0, float("nan")])
def test_a_number_that_is_no_speedup_is_refused(speedup: float) -> None:
    pacing = Pacing(2.0, Clock())
    with pytest.raises(SpeedupError, match=r"from 0\.001 to 100000"):
        pacing.set_speedup(speedup)
    assert pacing.speedup == 2.0


def test_reads_speedups() -> None:
    assert parse_speedup("20") == 20.0
    assert parse_speedup("0.5") == 0.5
    assert parse_speedup("max") is None


def test_a_busy_client_is_answered_and_does_not_hurry_the_clock() -> None:
    clock = Clock()

    class Busy:
        """A bridge whose sockets always have something to read, after a tenth of a millisecond."""

        answered = received = 0

        def wait(self, seconds: float) -> bool:
            clock.now += min(1e-4, seconds)
            return True

        def receive(self) -> None:
            self.answered += 1

    pacing, vehicle, bridge = Pacing(1.0, clock), Vehicle(clock), Busy()
    vehicle.bridge = bridge  # type: ignore[assignment]
    start = clock.now
    for _ in range(100):
        vehicle.advance_to(vehicle.time_us + pacing.slice_us)
        pacing.after_slice(vehicle)  # type: ignore[arg-type]
    assert clock.now - start == pytest.approx(100 * pacing.slice_us * 1e-6, rel=0.01)
    assert bridge.answered > 1000


def test_slices_grow_while_nobody_says_anything() -> None:
    clock, wall_s_a_simulated_s = Clock(), 1e-3
    pacing, vehicle = Pacing(None, clock), Vehicle(clock)
    for _ in range(500):
        clock.now += pacing.slice_us * 1e-6 * wall_s_a_simulated_s
        vehicle.time_us += pacing.slice_us
        pacing.after_slice(vehicle)  # type: ignore[arg-type]
        assert 20_000 <= pacing.slice_us <= max(20_000, vehicle.time_us // 10)
    assert pacing.slice_us * 1e-6 * wall_s_a_simulated_s == pytest.approx(1e-3, rel=0.01)
    vehicle.bridge.received = 1
    pacing.after_slice(vehicle)  # type: ignore[arg-type]
    assert pacing.slice_us == 20_000


@pytest.mark.parametrize("step_us", [2500, 100_000, 3_600_000_000])
def test_a_day_in_steps_of_the_callers_own(step_us: int) -> None:
    clock = Clock()
    pacing = Pacing(None, clock)
    for k in range(1, 20_000):
        clock.now += 1e-6
        pacing.listen(Silent(clock), k * step_us)
        assert pacing.slice_us <= LONGEST_QUIET_US
    start = clock.now
    assert flown(pacing, clock, 86_400.0) == clock.now - start == 0.0


def test_time_that_jumps_is_not_waited_for() -> None:
    clock = Clock()
    pacing, vehicle = Pacing(1.0, clock), Vehicle(clock)
    for time_us in (2500, 3_600_000_000, 5000, 7500):  # restored from a snapshot, and back
        vehicle.time_us = time_us
        pacing.after_slice(vehicle)  # type: ignore[arg-type]
    assert clock.now - 100.0 <= 4 * 5000e-6


Step = tuple[float, int, bool]
"""Wall time [s] and simulated time [us] that go by; whether clients have said something meanwhile."""


@settings(max_examples=100, deadline=None)
@given(
    st.one_of(st.none(), st.floats(1e-12, 1e30)),
    st.lists(st.tuples(st.floats(-1e3, 1e6), st.integers(-(10**9), 10**13), st.booleans()), min_size=1, max_size=30),
    st.sampled_from([1, 40]),
)
def test_slices_are_whole_ticks_within_their_bounds(speedup: float | None, steps: list[Step], times: int) -> None:
    clock = Clock()
    pacing, time_us, heard = Pacing(speedup, clock), 0, 0
    assert pacing.speedup is None or SLOWEST <= pacing.speedup <= FASTEST
    for took, passed_us, said in steps * times:
        clock.now += took
        time_us, heard = time_us + passed_us, heard + said
        listener = Silent(clock)
        listener.received = heard
        pacing.listen(listener, time_us)
        assert isinstance(pacing.slice_us, int) and TICK_US <= pacing.slice_us <= LONGEST_QUIET_US
        assert pacing.slice_us % TICK_US == 0
