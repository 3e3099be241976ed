# SPDX-License-Identifier: BSD-3-Clause
"""A vehicle at a connection that somebody else has started: how it takes off again, is put down, goes back, and why it
is not the agent's any more. The vehicle is a script."""

from __future__ import annotations

import math
from types import SimpleNamespace
from typing import Any

import pytest

from sitl.core.mavlink import MavLandedState, MavResult
from sitl.envs.mavlink.reports import LANDED, REPORTED
from sitl.envs.robots import at_connection
from sitl.envs.robots.at_connection import SocketVehicles
from sitl.errors import NotReadyError

GUIDED = 4


class Link:
    """What is sent, decoded; ``lands_at``: number of the pause after which the vehicle says that it has landed."""

    name, system, is_simulator = "tcp:1", 7, False

    def __init__(self) -> None:
        self.inbox: Any = SimpleNamespace(
            armed=True, mode=GUIDED, reports=[0.0] * REPORTED, position=[0.0] * 7, attitude=[0.0] * 7, time_ms=50_000,
        )  # fmt: skip
        self.inbox.reports[LANDED] = float(MavLandedState.IN_AIR)
        self.sent: list[Any] = []
        self.pauses: list[int] = []
        self.results: list[int] = [MavResult.ACCEPTED]
        self.commands: list[Any] = []
        self.after_pause: Any = lambda count: None
        self.values: dict[str, Any] = {}
        self.endpoint = SimpleNamespace(send_payload=self._payload, send=lambda name, **f: self.sent.append((name, f)))

    def _payload(self, kind: Any, payload: bytes) -> None:
        self.sent.append((kind.name, kind.decode(payload)))

    def command(self, name: str, **fields: Any) -> int:
        self.commands.append((name, fields))
        return self.results.pop(0) if len(self.results) > 1 else self.results[0]

    def pause(self, us: int) -> None:
        self.pauses.append(us)
        self.after_pause(len(self.pauses))

    def parameter(self, name: str) -> Any:
        return self.values.get(name)


def vehicles(link: Link, monkeypatch: pytest.MonkeyPatch, *, px4: bool = False, flies: bool = True, wait: float = 2.0,
             watch: Any = None) -> Any:  # fmt: skip
    """Of a copter whose first episode began 5 m above its home; heights are the test's."""
    found: Any = object.__new__(SocketVehicles)
    found._is_px4, found._may_sink_level, found._is_put_down = px4, None, False
    found._origin, found._first, found._height = (10.0, 20.0, -5.0), (1.0, 2.0, -3.0), 5.0
    found._pose, found._sank_ms, found._received_ms, found.lets_down = (0.0, 0.0, 0.5, 0.0), 0, -1000, 0.3
    found.setup = SimpleNamespace(
        kind=SimpleNamespace(guided=GUIDED, takes_off=flies, parameters={"thrust": ("GUID_OPTIONS", 8)})
    )
    found.options, found.watch, found.links = SimpleNamespace(wait=wait), watch, [link]
    found.landed, found.above = False, 5.0
    monkeypatch.setattr(at_connection, "has_landed", lambda link: found.landed)
    monkeypatch.setattr(at_connection, "height_above_home", lambda link: found.above)
    return found


# ---------------------------------------------------------------- take-off


def test_a_copter_that_has_landed_takes_off_to_where_it_was(monkeypatch: pytest.MonkeyPatch) -> None:
    link, notes = Link(), []  # type: ignore[var-annotated]
    made = vehicles(link, monkeypatch, watch=SimpleNamespace(note=lambda *note: notes.append(note)))
    made.landed, link.inbox.position[3] = True, 0.25
    made._lift_off(link)
    assert link.commands == [("NAV_TAKEOFF", {"altitude": 5.0})] and link.sent == []
    assert notes == [(50.0, "take-off", "it flies back")]
    assert made._origin == (10.0, 20.0, -0.75), "its height counts from the floor, which is 0.5 m up in the world"
    assert made._first == (1.0, 2.0, -4.75)


def test_before_it_knows_that_it_has_landed_it_is_to_sink(monkeypatch: pytest.MonkeyPatch) -> None:
    link = Link()
    made = vehicles(link, monkeypatch)
    made.above = 0.0
    link.values["GUID_OPTIONS"] = 8.0  # thrust is a thrust: level and sinking would be a fall

    def lands(count: int) -> None:
        made.landed = count == 3
        made.above = 4.1 if count == 4 else 0.0

    link.after_pause = lands
    made._lift_off(link)
    assert [name for name, _ in link.sent] == ["SET_POSITION_TARGET_LOCAL_NED"] * 3
    told = link.sent[0][1]
    assert (told.vx, told.vy, told.vz, told.target_system, told.target_component) == (
        0.0,
        0.0,
        pytest.approx(0.3),
        7,
        1,
    )
    assert link.pauses[:3] == [200_000] * 3 and link.pauses[3:] == [1_000_000], "until it is at its height"
    assert len(link.commands) == 1


def test_where_thrust_is_a_climb_rate_it_sinks_level(monkeypatch: pytest.MonkeyPatch) -> None:
    link = Link()
    made = vehicles(link, monkeypatch, wait=0.4)
    link.inbox.attitude[3] = math.pi / 2
    made._lift_off(link)
    assert [name for name, _ in link.sent] == ["SET_ATTITUDE_TARGET"] * 5 and link.commands == []
    told = link.sent[0][1]
    assert told.thrust == pytest.approx(0.4) and told.q == pytest.approx((math.sqrt(0.5), 0.0, 0.0, math.sqrt(0.5)))


def test_one_that_does_not_say_whether_it_has_landed_is_asked_to_take_off(monkeypatch: pytest.MonkeyPatch) -> None:
    link = Link()
    made = vehicles(link, monkeypatch)
    link.inbox.reports[LANDED] = 0.0
    link.results = [MavResult.FAILED, MavResult.ACCEPTED]
    made._lift_off(link)
    assert len(link.commands) == 2 and made._origin == (10.0, 20.0, -5.0), "nobody knows that it stands"


@pytest.mark.parametrize(("armed", "mode"), [(False, GUIDED), (True, 5)])
def test_one_that_is_not_ours_is_left_alone(armed: bool, mode: int, monkeypatch: pytest.MonkeyPatch) -> None:
    link = Link()
    link.inbox.armed, link.inbox.mode = armed, mode
    made = vehicles(link, monkeypatch)
    made.landed = True
    made._lift_off(link)
    made._go_back(link)
    assert link.commands == link.sent == link.pauses == []


@pytest.mark.parametrize(
    ("value", "px4", "may"), [(None, False, True), (0.0, False, True), (8.0, False, False), (7.0, False, True),
                              (0.0, True, False)],
)  # fmt: skip
def test_thrust_is_a_climb_rate_unless_guid_options_say_otherwise(
    value: Any, px4: bool, may: bool, monkeypatch: pytest.MonkeyPatch
) -> None:
    link = Link()
    link.values["GUID_OPTIONS"] = value
    made = vehicles(link, monkeypatch, px4=px4)
    assert made._sinks_level(link) == may
    link.values["GUID_OPTIONS"] = 8.0
    assert made._sinks_level(link) == may, "it is asked once"


# ---------------------------------------------------------------- put down


@pytest.mark.parametrize(
    ("height", "may", "px4", "put_down"),
    [(0.29, True, False, True), (0.3, True, False, False), (0.29, False, False, False), (0.29, None, True, True)],
)
def test_below_its_height_it_is_put_down_for_good(
    height: float, may: Any, px4: bool, put_down: bool, monkeypatch: pytest.MonkeyPatch
) -> None:
    notes: list[Any] = []
    made = vehicles(Link(), monkeypatch, px4=px4, watch=SimpleNamespace(note=lambda *note: notes.append(note)))
    made._may_sink_level = may
    assert made.puts_down(height) == put_down and made.puts_down(9.0) == put_down
    assert notes == ([(50.0, "put down", "at a height of 0.29 m")] if put_down else [])
    assert made._sank_ms == (51_000 if put_down else 0), "a second to get going"


@pytest.mark.parametrize(
    ("now_ms", "sinks", "px4", "level"),
    [
        (51_000, 0.0, False, False),
        (51_499, 0.0, False, False),
        (51_500, 0.0, False, True),
        (60_000, 0.1, False, True),
        (60_000, 0.11, False, False),  # it still sinks
        (60_000, 0.0, True, False),
    ],
)
def test_one_that_no_longer_sinks_stands_and_is_held_level(
    now_ms: int, sinks: float, px4: bool, level: bool, monkeypatch: pytest.MonkeyPatch
) -> None:
    link = Link()
    made = vehicles(link, monkeypatch, px4=px4)
    made._sank_ms, link.inbox.time_ms, link.inbox.position[6] = 51_000, now_ms, sinks
    made.put_down(link)
    assert [name for name, _ in link.sent] == ["SET_ATTITUDE_TARGET" if level else "SET_POSITION_TARGET_LOCAL_NED"]


# ---------------------------------------------------------------- back to where it began


@pytest.mark.parametrize(("px4", "pause_us"), [(False, 1_000_000), (True, 200_000)])
def test_it_goes_back_until_it_is_within_a_metre(px4: bool, pause_us: int, monkeypatch: pytest.MonkeyPatch) -> None:
    link = Link()
    made = vehicles(link, monkeypatch, px4=px4)
    link.after_pause = lambda number: link.inbox.position.__setitem__(
        slice(1, 4), (1.0, 2.0, -3.0 - 0.99 * (number > 1))
    )
    made._go_back(link)
    assert link.pauses == [pause_us]
    told = link.sent[0][1]
    assert (told.x, told.y, told.z, told.target_system) == (1.0, 2.0, -3.0, 7)


def test_one_that_does_not_come_back_is_told_with_its_distance(monkeypatch: pytest.MonkeyPatch) -> None:
    link = Link()
    made = vehicles(link, monkeypatch, wait=3.0)
    link.inbox.position[1:4] = 1.0, 2.0, 4.0
    with pytest.raises(NotReadyError, match=r"tcp:1: the vehicle is still 7\.0 m away from where the first episode"):
        made._go_back(link)
    assert link.pauses == [1_000_000] * 3
    link.inbox.position[3] = -2.0
    with pytest.raises(NotReadyError, match=r"still 1\.0 m away"):
        made._go_back(link)


@pytest.mark.parametrize(
    ("landed", "above", "flies", "px4", "lifts"),
    [(True, 5.0, True, False, True), (False, 0.49, True, False, True), (False, 0.5, True, False, False),
     (True, 0.0, False, False, False), (True, 0.0, True, True, False)],
)  # fmt: skip
def test_a_copter_on_the_ground_takes_off_first(
    landed: bool, above: float, flies: bool, px4: bool, lifts: bool, monkeypatch: pytest.MonkeyPatch
) -> None:
    link = Link()
    made = vehicles(link, monkeypatch, px4=px4, flies=flies)
    made.landed, made.above = landed, above
    lifted: list[Any] = []
    monkeypatch.setattr(made, "_lift_off", lifted.append, raising=False)
    link.inbox.position[1:4] = 1.0, 2.0, -3.0
    made._go_back(link)
    assert lifted == [link] * lifts


# ---------------------------------------------------------------- whose it is


@pytest.mark.parametrize(
    ("armed", "mode", "why"),
    [
        (True, GUIDED, ""),
        (False, GUIDED, "the vehicle is disarmed"),
        (True, 6, "the vehicle is in mode 6: its pilot or a failsafe has it"),
        (False, 6, "the vehicle is disarmed"),
    ],
)
def test_why_it_is_not_the_agents(armed: bool, mode: int, why: str, monkeypatch: pytest.MonkeyPatch) -> None:
    link = Link()
    link.inbox.armed, link.inbox.mode = armed, mode
    assert vehicles(link, monkeypatch).taken() == why


def test_once_a_second_it_hears_that_a_ground_station_is_there(monkeypatch: pytest.MonkeyPatch) -> None:
    link = Link()
    made = vehicles(link, monkeypatch)
    for ms in (0, 500, 999, 1000, 1500, 2000):
        link.inbox.time_ms = ms
        made.taken()
    beats = [fields for name, fields in link.sent if name == "HEARTBEAT"]
    assert len(beats) == 3 and (beats[0]["type"], beats[0]["autopilot"], beats[0]["system_status"]) == (6, 8, 4)
