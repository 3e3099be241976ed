# SPDX-License-Identifier: BSD-3-Clause
"""The library's missions for rovers."""

from __future__ import annotations

from typing import Any

from sitl.autopilot.mission import item as c

from .draft import Draft, circle, survey, transects

MAZE = (
    (8, -3), (4, -9), (-9, -8), (-11, 7), (-2, 14), (-5, 19), (-10, 22), (-5, 28), (16, 26),
    (20, 19), (26, 15), (24, 1), (18, -4), (21, -9), (34, -8), (37, 18), (43, 19), (47, -8),
    (72, -8), (73, -2), (64, 4), (62, 19), (56, 23), (58, 28), (73, 30), (73, 38),
)  # fmt: skip
"""Through maze_erlerover from its start to its exit, 2.9 m or more from every wall."""


def drafts() -> dict[str, Draft]:
    """Each by its name."""
    return {
        "square": rover("A square of 20 m").to((20, 0), (20, 20), (0, 20), (0, 0)),
        "square_by_skid": rover("A square of 12 m with turns on the spot", frame="skid_rover", text=True)
        .to((12, 0), (12, 12), (0, 12), (0, 0)),
        "square_fast": rover("A square of 40 m at 5 m/s", frame="ardupilot_rover", text=True)
        .to((40, 0), (40, 40), (0, 40), (0, 0)),
        "square_small": rover("A square of 4 m in the real robot's dimensions", frame="erle_rover_small")
        .to((4, 0), (4, 4), (0, 4), (0, 0)),
        "slalom": rover("Round five gates left and right of a straight line")
        .to(*[(10 * (k + 1), 4 * (-1) ** k) for k in range(5)], (60, 0)),
        "figure_eight": rover("Two circles of eight waypoints each, one to the left and one to the right")
        .to(*circle((0, 8), 8, 8, 270)[1:], *[(n, -e) for n, e in circle((0, 8), 8, 8, 270)]),
        "reverse": rover("Forwards, 10 m backwards, forwards again")
        .to((15, 0)).add(c.DO_SET_REVERSE, 1).to((5, 0)).add(c.DO_SET_REVERSE, 0).to((20, 8)),
        "speed_changes": rover("Legs of 15 m at 0.5, 1.2 and 0.8 m/s", text=True)
        .pace(0.5).to((12, 0)).pace(1.2).to((12, 15)).pace(0.8).to((0, 15)),
        "delivery": rover("Stops of 4, 6 and 2 seconds at three places, and home")
        .to((15, 0), wait=4.0).to((15, 12)).add(c.NAV_DELAY, 6, -1, -1, -1).to((0, 12), wait=2.0).home(),
        "jump_loop": rover("A triangle driven twice by a jump", text=True)
        .to((12, 0), (12, 12), (0, 0)).jump(1, 1),
        "circles": rover("Two turns on a circle of 5 m").to((6, 0)).add(c.NAV_LOITER_TURNS, 2, 0, 5, at=(12, 0)),
        "loiter_times": rover("Stays of 5 and 3 seconds")
        .add(c.NAV_LOITER_TIME, 5, at=(10, 0)).add(c.NAV_LOITER_TIME, 3, at=(10, 10)),
        "headings": rover("Turns to headings at a walking speed, between two places")
        .to((8, 0)).add(c.NAV_SET_YAW_SPEED, 90, 0.8, 0).add(c.NAV_SET_YAW_SPEED, 90, 0.8, 1).to((0, 10)),
        "mowing": rover("A meadow of 24 m by 20 m, in lines 5 m apart")
        .complex(survey([(4, 4), (28, 4), (28, 24), (4, 24)], 0.0, transects(5.0, 0.0), 2)).home(),
        "return_home": rover("Out and back by return to launch").to((15, 5), (20, 15)).home(),
        "maze_route": rover("Through the maze to its exit", world="maze_erlerover").to(*MAZE),
    }  # fmt: skip


def rover(description: str, *, text: bool = False, frame: str = "erle_rover", **index: Any) -> Draft:
    """An empty mission."""
    return Draft("rover", description, text=text, frame=frame, **index)
