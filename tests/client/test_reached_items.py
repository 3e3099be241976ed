# SPDX-License-Identifier: BSD-3-Clause
"""Mission items that were reached, from what vehicles tell of them."""

from __future__ import annotations

from types import SimpleNamespace

import pytest

from sitl.client.telemetry import Telemetry


def reached(*told: tuple[str, int]) -> list[int]:
    telemetry = Telemetry()
    for name, seq in told:
        telemetry.take(1.0, name, SimpleNamespace(seq=seq, mission_state=3, total=9))
    return [seq for _, seq in telemetry.reached]


CURRENT, REACHED = "MISSION_CURRENT", "MISSION_ITEM_REACHED"


@pytest.mark.parametrize(
    ("told", "items"),
    [
        ([(CURRENT, 1), (REACHED, 1), (CURRENT, 2), (REACHED, 2)], [1, 2]),
        ([(CURRENT, 1), (REACHED, 1), (REACHED, 2), (CURRENT, 3)], [1, 2]),
        ([(CURRENT, 1), (CURRENT, 3), (REACHED, 2), (REACHED, 3)], [1, 2, 3]),  # as ours: of 1 and 2 only 2 is told
        ([(CURRENT, 1), (REACHED, 2), (CURRENT, 3), (REACHED, 3)], [1, 2, 3]),  # the same in ArduPilot's order
        ([(CURRENT, 1), (CURRENT, 5), (REACHED, 5)], [5]),  # by MISSION_SET_CURRENT
        ([(CURRENT, 0), (REACHED, 1), (CURRENT, 2)], [1]),
        ([(CURRENT, 4), (CURRENT, 2), (REACHED, 2)], [2]),  # by a jump
    ],
)
def test_of_a_waypoint_and_a_do_command_behind_it_only_one_is_told(
    told: list[tuple[str, int]], items: list[int]
) -> None:
    assert reached(*told) == items
