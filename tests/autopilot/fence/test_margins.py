# SPDX-License-Identifier: BSD-3-Clause
"""Room that is kept to fences: FENCE_MARGIN, FENCE_MARGIN_XY."""

from __future__ import annotations

import pytest

from sitl.autopilot.fence import arming
from sitl.autopilot.fence.checks import margin_of
from sitl.autopilot.fence.state import AREAS, CIRCLE, MAX_ALT, MIN_ALT, FenceState
from sitl.autopilot.params.fence_parameters import Fence
from sitl.autopilot.state import Estimate, HomeState
from sitl.core.vectors import Vec3


def params(margin: float, horizontal: float) -> Fence:
    p = Fence()
    p.ENABLE, p.TYPE, p.RADIUS, p.MARGIN, p.MARGIN_XY = 1.0, MAX_ALT | CIRCLE, 30.0, margin, horizontal
    return p


@pytest.mark.parametrize(("horizontal", "sideways"), [(5.0, 5.0), (0.0, 2.0), (-1.0, 2.0)])
def test_the_circle_and_areas_may_have_another_one(horizontal: float, sideways: float) -> None:
    p = params(2.0, horizontal)
    assert [margin_of(kind, p) for kind in (MAX_ALT, CIRCLE, AREAS, MIN_ALT)] == [2.0, sideways, sideways, 2.0]


@pytest.mark.parametrize(
    ("margin", "horizontal", "said"),
    [
        (2.0, 5.0, ""), (2.0, -1.0, "Invalid FENCE_MARGIN_XY value"), (-1.0, -1.0, "Invalid FENCE_MARGIN value"),
        (2.0, 31.0, "Circle FENCE_MARGIN is greater than FENCE_RADIUS"), (31.0, 5.0, ""),
        (2.0, 0.5, ""), (0.5, 0.0, ""),
    ],
)  # fmt: skip
def test_what_arming_says_of_them(margin: float, horizontal: float, said: str) -> None:
    fence, estimate, home = FenceState(), Estimate(), HomeState()
    fence.on, estimate.origin_set, home.is_set = MAX_ALT | CIRCLE, True, True
    refusal = arming.refusal(fence, estimate, home, params(margin, horizontal), Vec3(100.0, -10.0, 0.0))
    assert (arming.text(refusal) if refusal else "") == said
