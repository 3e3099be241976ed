# SPDX-License-Identifier: BSD-3-Clause
"""One step of a vehicle at a connection, which is a script: what it is sent and when, what of it is read."""

from __future__ import annotations

from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

from sitl.envs import EnvOptionError
from sitl.envs.robots import autopilot
from sitl.envs.robots.autopilot import AutopilotRobot
from sitl.envs.robots.vehicles import EpisodeState
from sitl.errors import LinkLostError


class Link:
    """Time, telemetry and what was sent; ``tells``: what has come after each run, by its number."""

    name, is_exact, is_held = "tcp:1", False, True

    def __init__(self) -> None:
        self.inbox: Any = SimpleNamespace(
            hits=3, scans=5, position=(1000, 0.0), attitude=(1000, 0.0), longest_interval_us=1 << 62, reported=set(),
            wanted=(), scans_used=True, time_ms=1000,
        )  # fmt: skip
        self.done: list[Any] = []
        self.endpoint = SimpleNamespace(send_payload=lambda *message: self.done.append(message))
        self.hits_at = self.scan_at = -1
        self.stale_ms = 0

    def run(self, us: int) -> None:
        self.done.append(us)
        number, inbox = sum(isinstance(x, int) for x in self.done), self.inbox
        inbox.hits += number == self.hits_at
        inbox.scans += number == self.scan_at
        now = inbox.position[0] + us // 1000
        inbox.position, inbox.attitude = (now, 0.0), (now - self.stale_ms, 0.0)


class Watch:
    def __init__(self) -> None:
        self.in_charge, self.steps = True, 0
        self.asked: list[Any] = []

    def limited(self, setpoint: Any, row: list[float], pose: list[float], seconds: float) -> list[float]:
        self.asked.append((setpoint.name, row, pose, seconds))
        return [0.5 * x for x in row]

    def stepped(self) -> None:
        self.steps += 1


def robot(link: Link | None, *, repeat_us: int = 0, watch: Watch | None = None) -> Any:
    found: Any = object.__new__(AutopilotRobot)
    found._setpoint = SimpleNamespace(name="velocity")
    found._vehicles = SimpleNamespace(links=[link], watch=watch, where="tcp:1", simulates=True)
    found._states = [EpisodeState(None, None, (1, 2, 3), 0, "velocity", 100_000)]
    found._commands, found._sent = np.array([[1.0, 2.0, 3.0, 4.0]]), [None]
    found.collided, found.over, found.pose = np.array([9]), np.array([False]), np.array([[7.0, 8.0, 9.0, 0.0]])
    found.kind = SimpleNamespace(
        encode={"velocity": lambda row, inbox, origin: ("VELOCITY", tuple(row), origin)}, repeat_us=repeat_us,
        are_alike=lambda a, b: {a, b} == {"velocity", "position"},
    )  # fmt: skip
    found.read = []
    found._read = found.read.append
    found._puts_down = lambda index, link: False
    found.changed = []

    def change(link: Any, now: Any, setpoint: str, interval_us: int) -> Any:
        found.changed.append((setpoint, interval_us))
        return EpisodeState(None, None, now.origin, now.began_us, setpoint, interval_us)

    found._change = change
    return found


SENT = ("VELOCITY", (1.0, 2.0, 3.0, 4.0), (1, 2, 3))


@pytest.mark.parametrize(("hits_at", "collided"), [(-1, False), (1, True)])
def test_a_step_sends_its_set_point_and_tells_whether_something_was_touched(hits_at: int, collided: bool) -> None:
    link = Link()
    link.hits_at = hits_at
    made = robot(link)
    made._step(0, 100_000)
    assert link.done == [SENT, 100_000] and made.read == [0] and made.changed == []
    assert bool(made.collided[0]) == collided
    made._step(0, 100_000)
    assert not made.collided[0], "in this step alone"


def test_without_a_link_there_is_none() -> None:
    with pytest.raises(LinkLostError, match=r"tcp:1 is not open; reset\(\) opens it"):
        robot(None)._step(0, 100_000)


@pytest.mark.parametrize(
    ("repeat_us", "us", "done"),
    [
        (0, 100_000, [SENT, 100_000]),
        (100_000, 100_000, [SENT, 100_000]),
        (40_000, 100_000, [SENT, 40_000, SENT, 40_000, SENT, 20_000]),
        (50_000, 100_000, [SENT, 50_000, SENT, 50_000]),
    ],
)
def test_a_vehicle_that_forgets_its_set_point_gets_it_again(repeat_us: int, us: int, done: list[Any]) -> None:
    link = Link()
    robot(link, repeat_us=repeat_us)._step(0, us)
    assert link.done == done


@pytest.mark.parametrize(
    ("wait_us", "done"),
    [(0, [SENT, 100_000]), (30_000, [30_000, SENT, 70_000]), (100_000, [100_000])],
)
def test_a_late_set_point_is_sent_within_the_step(wait_us: int, done: list[Any]) -> None:
    link = Link()
    robot(link)._step(0, 100_000, wait_us)
    assert link.done == done


def test_a_clock_that_cannot_be_held_has_no_latency() -> None:
    link = Link()
    link.is_held = False
    robot(link)._step(0, 100_000)
    with pytest.raises(EnvOptionError, match="latency: the clock of tcp:1 cannot be held within a step"):
        robot(link)._step(0, 100_000, 1)


@pytest.mark.parametrize(
    ("us", "longest_us", "before", "changed"),
    [
        (100_000, 1 << 62, ("velocity", 100_000), []),
        (100_000, 1 << 62, ("position", 100_000), []),  # the same mode takes both
        (100_000, 1 << 62, ("attitude", 100_000), [("velocity", 100_000)]),
        (250_000, 1 << 62, ("velocity", 250_000), []),
        (70_000, 1 << 62, ("velocity", 100_000), [("velocity", 10_000)]),  # 6 s are no multiple of 70 ms
        (100_000, 50_000, ("velocity", 100_000), [("velocity", 50_000)]),
    ],
)
def test_another_step_or_set_point_needs_other_intervals_or_another_mode(
    us: int, longest_us: int, before: Any, changed: list[Any]
) -> None:
    link = Link()
    link.inbox.longest_interval_us = longest_us
    made = robot(link)
    made._states = [EpisodeState(None, None, (1, 2, 3), 0, *before)]
    made._step(0, us)
    assert made.changed == changed
    made.changed.clear()
    made._step(0, us)
    assert made.changed == [], "once"


@pytest.mark.parametrize(
    ("scan_at", "stale_ms", "wanted", "scans_used", "ok"),
    [
        (1, 0, 0, True, True),
        (-1, 0, 0, True, False),
        (-1, 0, 0, False, True),
        (1, 100, 0, True, False),
        (1, 0, 1, True, False),
    ],
)
def test_in_exact_time_all_telemetry_is_of_this_step(
    scan_at: int, stale_ms: int, wanted: int, scans_used: bool, ok: bool, monkeypatch: pytest.MonkeyPatch
) -> None:
    again: list[Any] = []
    monkeypatch.setattr(autopilot, "request_again", again.append)
    link = Link()
    link.is_exact, link.scan_at, link.stale_ms = True, scan_at, stale_ms
    link.inbox.wanted, link.inbox.scans_used = ("WIND",) * wanted, scans_used
    made = robot(link)
    if ok:
        made._step(0, 100_000)
        assert again == []
        return
    with pytest.raises(LinkLostError, match="tcp:1: the vehicle's telemetry is not of this step: has it been rebooted"):
        made._step(0, 100_000)
    assert again == [link] * autopilot._TRIES and made.read == []


def test_what_was_lost_on_the_way_is_asked_for_until_it_has_come(monkeypatch: pytest.MonkeyPatch) -> None:
    link = Link()
    link.is_exact = True
    monkeypatch.setattr(autopilot, "request_again", lambda link: setattr(link.inbox, "scans", 6))
    robot(link)._step(0, 100_000)


def test_a_guard_limits_what_is_sent_and_counts_steps() -> None:
    link, watch = Link(), Watch()
    made = robot(link, watch=watch)
    made._allows = lambda index, watch, row: True
    made._step(0, 100_000)
    assert link.done == [("VELOCITY", (0.5, 1.0, 1.5, 2.0), (1, 2, 3)), 100_000] and watch.steps == 1
    assert watch.asked == [("velocity", [1.0, 2.0, 3.0, 4.0], [7.0, 8.0, 9.0, 0.0], 1.0)]


def test_an_agent_that_is_not_in_charge_sends_nothing() -> None:
    link, watch = Link(), Watch()
    made = robot(link, watch=watch)
    made._allows = lambda index, watch, row: False
    made._step(0, 100_000)
    assert link.done == [100_000] and made.read == [0] and watch.steps == 1


def test_one_that_is_being_put_down_gets_no_set_point() -> None:
    link = Link()
    made = robot(link, repeat_us=20_000)
    made._sent = [SENT]
    made._puts_down = lambda index, link: True
    made._step(0, 100_000)
    assert link.done == [100_000] and made._sent == [None]
