# SPDX-License-Identifier: BSD-3-Clause
"""How an environment takes over a PX4 that somebody flies, and brings one up itself: what is sent when, what lacks.

The PX4 is a script: it answers commands and moves as a test says.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import Any

import pytest

from sitl.core.mavlink import MavResult
from sitl.envs.mavlink import px4
from sitl.envs.mavlink.last_messages import StepTelemetry
from sitl.errors import NotReadyError

ACCEPTED, DENIED = MavResult.ACCEPTED, MavResult.DENIED
TENTH = 100_000


class Px4:
    """A link to one that hovers 2 m above home in Hold, heading east; ``each``: called with its time at each look."""

    name, simulation, is_exact = "px4", None, False

    def __init__(self, each: Callable[[Px4], None] = lambda link: None) -> None:
        self.inbox: Any = StepTelemetry(0)
        self.inbox.system, self.inbox.mode, self.inbox.armed = 7, px4.HOLD, True
        self.inbox.origin = (1, 2, 3)
        self.us = 0
        self.place(5.0, -3.0, -2.0)
        self.endpoint = self
        self.sent: list[tuple[str, Any]] = []
        self.commands: list[tuple[Any, ...]] = []
        self.refuses: set[str] = set()
        self.each = each

    def place(self, north: float, east: float, down: float, climb: float = 0.0) -> None:
        now_ms = self.us // 1000
        self.inbox.position = (now_ms, north, east, down, 0.0, 0.0, climb)
        self.inbox.attitude = (now_ms, 0.0, 0.0, math.pi / 2, 0.0, 0.0, 0.0)

    def send_payload(self, kind: Any, payload: bytes) -> None:
        self.sent.append((kind.name, kind.decode(payload)))

    def command(self, name: str, *params: Any, **named: Any) -> int:
        self.commands.append((name, *params, *named.values()))
        if name == "REQUEST_MESSAGE":
            self.inbox.height = 2.0
        if name in self.refuses:
            return DENIED
        if name == "DO_SET_MODE" and params == (1, 6, 0):
            self.inbox.mode = px4.OFFBOARD
        if name == "COMPONENT_ARM_DISARM":
            self.inbox.armed = True
        return ACCEPTED

    def run(self, us: int) -> None:
        self.us += us
        self.inbox.position = (self.us // 1000, *self.inbox.position[1:])
        self.inbox.attitude = (self.us // 1000, *self.inbox.attitude[1:])
        self.each(self)

    pause = run

    @property
    def seconds(self) -> float:
        return round(1e-6 * self.us, 6)

    def names(self) -> list[str]:
        return [name for name, *_ in self.commands]


# ---------------------------------------------------------------- taking one over


def test_one_in_hold_is_taken_over_where_it_is() -> None:
    link = Px4()
    px4.join(link, 5.0)  # type: ignore[arg-type]
    assert link.inbox.mode == px4.OFFBOARD
    positions = [m for name, m in link.sent if name == "SET_POSITION_TARGET_LOCAL_NED"]
    assert len(positions) == len(link.sent) == 11, "for a second before OFFBOARD is asked for, and on"
    for m in positions:
        assert (m.x, m.y, m.z) == pytest.approx((5.0, -3.0, -2.0)) and m.yaw == pytest.approx(math.pi / 2)
        assert (m.target_system, m.target_component, m.coordinate_frame) == (7, 1, 1)
        assert m.type_mask & 0o7 == 0 and m.type_mask & 0o770 == 0o770 and m.type_mask & 3072 == 2048
    assert ("DO_SET_MODE", 1, 6, 0) in link.commands


def test_it_stays_where_it_was_first_though_it_drifts() -> None:
    link = Px4(lambda link: link.place(5.0 + link.seconds, -3.0, -2.0))
    px4.join(link, 5.0)  # type: ignore[arg-type]
    assert {round(m.x, 3) for _, m in link.sent} == {5.1}


def test_one_in_offboard_is_ours_already() -> None:
    link = Px4()
    link.inbox.mode = px4.OFFBOARD
    px4.join(link, 5.0)  # type: ignore[arg-type]
    assert "DO_SET_MODE" not in link.names() and len(link.sent) == 12, "set-points come from the first look on"


@pytest.mark.parametrize(
    ("spoil", "told"),
    [
        (lambda i: setattr(i, "mode", 3 << 16), r"it is in mode \(3, 0\), not in Hold \(4, 3\) or OFFBOARD \(6, 0\)"),
        (lambda i: setattr(i, "armed", False), "it is disarmed"),
        (lambda i: setattr(i, "origin", None), "it has no position"),
        (lambda i: setattr(i, "position", (0, 5.0, 0.0, -2.0, 0.6, 0.0, 0.0)), "it moves with 0.6 m/s"),
    ],
)
def test_what_is_missing_is_said_when_time_is_up(spoil: Callable[[Any], None], told: str) -> None:
    link = Px4()
    spoil(link.inbox)
    with pytest.raises(NotReadyError, match=f"px4: no episode can begin within 3 s: {told}; it said nothing"):
        px4.join(link, 3.0)  # type: ignore[arg-type]
    assert link.sent == [] and "DO_SET_MODE" not in link.names()


def test_it_waits_until_somebody_has_brought_it_there() -> None:
    link = Px4(lambda link: setattr(link.inbox, "armed", link.seconds >= 2.0))
    link.inbox.armed = False
    px4.join(link, 5.0)  # type: ignore[arg-type]
    assert link.seconds == pytest.approx(2.0 + 1.0 + 0.1)


def test_a_refused_offboard_is_said() -> None:
    link = Px4()
    link.refuses.add("DO_SET_MODE")
    with pytest.raises(NotReadyError, match="px4: the vehicle refuses mode 393216; it said nothing"):
        px4.join(link, 5.0)  # type: ignore[arg-type]


def test_one_that_accepts_offboard_and_does_not_go_there_is_told() -> None:
    link = Px4(lambda link: setattr(link.inbox, "mode", px4.HOLD))
    link.inbox.last_texts.append("No offboard signal")
    with pytest.raises(NotReadyError, match="accepts OFFBOARD and is not in it; it said: No offboard signal"):
        px4.join(link, 5.0)  # type: ignore[arg-type]


# ---------------------------------------------------------------- bringing one up


def climbing(link: Px4) -> None:
    """Valid after 2 s; it climbs half a metre a second from the last set-point's arming on; a scan each tenth."""
    if link.seconds >= 2.0:
        link.inbox.estimator = 1 | 2 | 4 | 16 | 32
    if link.inbox.armed:
        down = max(link.inbox.position[3] - 0.05, -4.0)
        link.place(1.0, 2.0, down, -0.5 if down > -4.0 else 0.0)
        link.inbox.scans += 1


def grounded() -> Px4:
    link = Px4(climbing)
    link.inbox.armed, link.inbox.mode = False, px4.HOLD
    link.place(1.0, 2.0, -1.0)
    return link


def test_from_power_on_to_hovering() -> None:
    link = grounded()
    px4.prepare(link, 3.0)  # type: ignore[arg-type]
    assert link.inbox.mode == px4.OFFBOARD and link.inbox.armed
    assert {(m.x, m.y, round(m.z, 6), round(m.yaw, 5)) for _, m in link.sent} == {(1.0, 2.0, -4.0, 1.5708)}
    first = link.commands.index(("DO_SET_MODE", 1, 6, 0))
    assert link.commands[first + 1] == ("COMPONENT_ARM_DISARM", 1), "armed in OFFBOARD"
    assert abs(link.inbox.position[3] + 4.0) < 0.15


@pytest.mark.parametrize(
    ("spoil", "told"),
    [
        (lambda link: setattr(link, "each", lambda link: None), "does not hold its position for valid within 90 s"),
        (lambda link: link.refuses.add("DO_SET_MODE"), "does not arm in OFFBOARD within 90 s"),
        (lambda link: link.refuses.add("COMPONENT_ARM_DISARM"), "does not arm in OFFBOARD within 90 s"),
        (lambda link: setattr(link.inbox, "origin", None), "does not send GPS_GLOBAL_ORIGIN"),
    ],
)
def test_one_that_does_not_get_there_says_why(spoil: Callable[[Px4], Any], told: str) -> None:
    link = grounded()
    spoil(link)
    with pytest.raises(NotReadyError, match=told):
        px4.prepare(link, 3.0)  # type: ignore[arg-type]


def test_one_that_stays_on_the_ground_or_sees_nothing_says_so() -> None:
    def valid(link: Px4) -> None:
        link.inbox.estimator = 0xFF

    link = grounded()
    link.each = valid
    with pytest.raises(NotReadyError, match="does not climb to 3 m within 30 s"):
        px4.prepare(link, 3.0)  # type: ignore[arg-type]

    def blind(link: Px4) -> None:
        climbing(link)
        link.inbox.scans = 0

    link = grounded()
    link.each = blind
    with pytest.raises(NotReadyError, match="the physics sends no scan"):
        px4.prepare(link, 3.0)  # type: ignore[arg-type]


@pytest.mark.parametrize("bit", [1, 2, 4, 16, 32])
def test_each_part_of_a_valid_estimate_is_needed(bit: int) -> None:
    """ESTIMATOR_STATUS_FLAGS: attitude, horizontal and vertical velocity, horizontal and vertical position."""

    def partly(link: Px4) -> None:
        climbing(link)
        link.inbox.estimator &= ~bit

    link = grounded()
    link.each = partly
    with pytest.raises(NotReadyError, match="does not hold its position for valid"):
        px4.prepare(link, 3.0)  # type: ignore[arg-type]


# ---------------------------------------------------------------- between kinds of set-points


def test_sticks_rest_before_a_mode_that_is_flown_by_them() -> None:
    link = Px4()
    px4.show_sticks(link)  # type: ignore[arg-type]
    assert [name for name, _ in link.sent] == ["MANUAL_CONTROL"] * 11 and link.seconds == 0.5
    assert {(m.x, m.y, m.z, m.r) for _, m in link.sent} == {(0, 0, 500, 0)}


def test_it_hovers_while_px4_notices_another_kind() -> None:
    link = Px4()
    px4.switch(px4.acceleration)(link)  # type: ignore[arg-type]
    assert link.seconds == pytest.approx(0.6) and "REQUEST_MESSAGE" not in link.names()
    assert {(m.afx, m.afy, m.afz, m.yaw_rate) for _, m in link.sent} == {(0.0, 0.0, 0.0, 0.0)} and len(link.sent) == 6


def test_by_thrust_it_hovers_with_that_of_its_own_loops() -> None:
    def answers(link: Px4) -> None:
        if link.inbox.witness is not None and link.seconds >= 0.2:
            link.inbox.witness(px4._ASKED, px4._ASKED.decode(px4._ASKED.payload(thrust=0.375)))
            link.inbox.witness(px4.LOCAL, px4.LOCAL.decode(px4.LOCAL.payload()))

    link = Px4(answers)
    px4.switch(px4.thrust)(link)  # type: ignore[arg-type]
    assert {m.thrust for _, m in link.sent} == {0.375} and len(link.sent) == 6
    assert link.inbox.witness is None and link.seconds == pytest.approx(0.2 + 0.6)
    link = Px4()
    with pytest.raises(NotReadyError, match="px4: the vehicle does not send ATTITUDE_TARGET"):
        px4.switch(px4.rates)(link)  # type: ignore[arg-type]
    assert link.inbox.witness is None and link.seconds == 0.5
