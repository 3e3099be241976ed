# SPDX-License-Identifier: BSD-3-Clause
"""What an environment asks a vehicle before an episode: whether it has landed, how high it is, and what it lacks.

The vehicle is a script: it answers a request when a test says.
"""

from __future__ import annotations

import math
from typing import Any

import pytest

from sitl.core.mavlink import MavLandedState, MavResult
from sitl.envs.mavlink.last_messages import GLOBAL, LANDED_STATE, StepTelemetry
from sitl.envs.mavlink.preparation import has_landed, height_above_home, last_texts, not_ready, until
from sitl.envs.mavlink.reports import LANDED
from sitl.errors import NotReadyError


class Asked:
    """A link to one that answers its ``answers_at``-th request, so many looks later; 0: never."""

    name = "vehicle"

    def __init__(self, answers_at: int = 1, looks: int = 0, result: int = MavResult.ACCEPTED, exact: bool = False):
        self.inbox: Any = StepTelemetry(0)
        self.is_exact, self.answers_at, self.result = exact, answers_at, result
        self.looks, self.left, self.us = looks, -1, 0
        self.requests: list[int] = []
        self.state, self.height = float(MavLandedState.ON_GROUND), 12.5

    def command(self, name: str, kind: int) -> int:
        assert name == "REQUEST_MESSAGE"
        self.requests.append(kind)
        if len(self.requests) == self.answers_at:
            self.left = self.looks
            self._arrive()
        return self.result

    def pause(self, us: int) -> None:
        self.us += us
        if self.left > 0:
            self.left -= 1
            self._arrive()

    def _arrive(self) -> None:
        if self.left == 0:
            self.inbox.reports[LANDED], self.inbox.height = self.state, self.height


def landed(link: Asked) -> bool:
    return has_landed(link)  # type: ignore[arg-type]


def height(link: Asked) -> float:
    return height_above_home(link)  # type: ignore[arg-type]


def test_it_says_whether_it_is_on_the_ground() -> None:
    link = Asked()
    assert landed(link) is True and link.requests == [LANDED_STATE.id] and link.us == 0
    link = Asked()
    link.state = float(MavLandedState.IN_AIR)
    assert landed(link) is False and link.requests == [LANDED_STATE.id]


def test_what_it_said_before_does_not_count() -> None:
    link = Asked(answers_at=0)
    link.inbox.reports[LANDED] = float(MavLandedState.ON_GROUND)
    assert landed(link) is False
    link = Asked(answers_at=0)
    link.inbox.height = 3.0
    with pytest.raises(NotReadyError, match="does not send GLOBAL_POSITION_INT"):
        height(link)


def test_one_that_refuses_is_not_asked_again_and_has_not_landed() -> None:
    link = Asked(result=MavResult.DENIED)
    assert landed(link) is False and link.requests == [LANDED_STATE.id] and link.us == 0


def test_an_answer_may_come_half_a_second_after_the_acknowledgement() -> None:
    for ask in (landed, height):
        link = Asked(looks=24)
        ask(link)
        assert len(link.requests) == 1 and link.us == 24 * 20_000


def test_it_is_asked_again() -> None:
    link = Asked(answers_at=3)
    assert landed(link) is True and link.requests == [LANDED_STATE.id] * 3 and link.us == 2 * 25 * 20_000
    link = Asked(answers_at=3)
    assert height(link) == 12.5 and link.requests == [GLOBAL.id] * 3


def test_one_in_our_own_time_has_answered_at_the_first_look() -> None:
    link = Asked(answers_at=2, exact=True)
    assert landed(link) is True and len(link.requests) == 2 and link.us == 0
    link = Asked(answers_at=2, exact=True)
    assert height(link) == 12.5 and len(link.requests) == 2 and link.us == 0


# ---------------------------------------------------------------- what it lacks


def ready(speed: float = 0.0, up: float = 12.5, **fields: Any) -> Asked:
    link = Asked()
    link.inbox.position, link.inbox.origin = (0, 1.0, 2.0, -3.0, 0.6 * speed, 0.0, -0.8 * speed), (1, 2, 3)
    link.inbox.armed, link.height = True, up
    for name, value in fields.items():
        setattr(link.inbox, name, value)
    return link


@pytest.mark.parametrize(
    "link, flies, lacks",
    [
        (ready(), True, ""),
        (ready(origin=None), True, "it has no position"),
        (ready(position=(0, math.nan, 0.0, 0.0, 0.0, 0.0, 0.0)), True, "it has no position"),
        (ready(armed=False), True, "it is disarmed"),
        (ready(up=0.49), True, "it is on the ground"),
        (ready(up=0.5), True, ""),
        (ready(up=0.49), False, ""),
        (ready(speed=0.5), True, ""),
        (ready(speed=0.51), True, "it moves with 0.5 m/s"),
        (ready(speed=2.0), False, "it moves with 2.0 m/s"),
    ],
)
def test_what_it_lacks(link: Asked, flies: bool, lacks: str) -> None:
    assert not_ready(link, flies) == lacks  # type: ignore[arg-type]


def test_only_one_that_flies_is_asked_for_its_height() -> None:
    link = ready()
    not_ready(link, False)  # type: ignore[arg-type]
    assert link.requests == []


# ---------------------------------------------------------------- waiting


def test_waiting_ends_with_what_it_said_last() -> None:
    link = Asked()
    assert last_texts(link) == "it said nothing"  # type: ignore[arg-type]
    for text in "abcde":
        link.inbox.last_texts.append(text)
    with pytest.raises(NotReadyError, match=r"^vehicle: the vehicle sleeps within 2 s; it said: b; c; d; e$"):
        until(link, lambda: False, 500_000, "sleeps", seconds=2)  # type: ignore[arg-type]
    assert link.us == 2_000_000


def test_waiting_goes_on_until_it_is_done() -> None:
    link, between = Asked(), []
    until(
        link,  # type: ignore[arg-type]
        lambda: link.us >= 1_500_000,
        500_000,
        "sleeps",
        between=lambda: between.append(link.us),
    )
    assert link.us == 1_500_000 and between == [0, 500_000, 1_000_000]
