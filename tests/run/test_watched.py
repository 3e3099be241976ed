# SPDX-License-Identifier: BSD-3-Clause
"""Who watches a run gets frames when free, 30 a second at most; a run can be stopped and taken by steps."""

from __future__ import annotations

from sitl import Simulation
from sitl.client import Endpoint
from sitl.run.pacing import StoppablePacing
from sitl.run.runner import serve
from sitl.run.watched import Watched
from sitl.simulation import Core


class Clock:
    now = 100.0

    def __call__(self) -> float:
        return self.now


class Watcher:
    """A viewer that counts."""

    def __init__(self) -> None:
        self.is_seen, self.is_free = True, True
        self.attended, self.factors = 0, list[float]()

    def attend(self) -> None:
        self.attended += 1

    def capture(self, factor: float) -> None:
        self.factors.append(factor)


def watch(seconds: float, watcher: Watcher, factor: float = 5.0) -> Clock:
    """Slices of a millisecond of wall time each."""
    clock = Clock()
    start = clock.now
    watched = Watched(watcher, lambda: round(factor * 1e6 * (clock.now - start)), clock=clock)
    for _ in range(round(1000 * seconds)):
        watched()
        clock.now += 0.001
    return clock


def test_thirty_frames_a_second_at_most() -> None:
    watcher = Watcher()
    watch(2.0, watcher)
    assert 55 <= len(watcher.factors) <= 61 and watcher.attended == 2000
    assert abs(watcher.factors[-1] - 5.0) < 0.1, "how fast time goes"


def test_few_while_nobody_looks_and_none_while_it_draws() -> None:
    unseen, busy = Watcher(), Watcher()
    unseen.is_seen, busy.is_free = False, False
    watch(2.0, unseen)
    watch(2.0, busy)
    assert len(unseen.factors) == 4 and not busy.factors


def test_stopped_time_stands_while_clients_are_heard(core: Core) -> None:
    simulation = Simulation("erle_copter", core=core)
    station = Endpoint()
    simulation.bridge.add_link(station.link)
    pace = StoppablePacing(None)
    serve(simulation, pace, until_us=1_000_000)
    pace.stop()
    station.send("PARAM_SET", target_system=1, target_component=1, param_id=b"RTL_ALT", param_value=2000, param_type=9)
    left = iter(range(5))
    serve(simulation, pace, running=lambda: next(left, None) is not None)
    assert simulation.time_us == 1_000_000 and simulation.parameters["RTL_ALT"] == 2000.0
    pace.step(300_000)
    left = iter(range(5))
    serve(simulation, pace, running=lambda: next(left, None) is not None)
    assert simulation.time_us == 1_300_000, "one step, then it stands again"
    orders = iter([lambda: pace.step(2500)])
    left = iter(range(5))
    serve(simulation, pace, running=lambda: next(left, None) is not None, on_slice=lambda: next(orders, lambda: None)())
    assert simulation.time_us == 1_302_500, "asked for between two slices, as the page does"
    pace.set_speedup(None)
    assert pace.slice_us == 0, "another speed does not let it go"
    pace.go_on()
    serve(simulation, pace, until_us=2_000_000)
    assert simulation.time_us == 2_000_000
