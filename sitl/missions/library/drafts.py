# SPDX-License-Identifier: BSD-3-Clause
"""The library's missions for copters."""

from __future__ import annotations

import math
from typing import Any

from sitl.core.elementary import cos, sin
from sitl.core.mavlink import MavCmd, MavFrame

from .draft import Draft, FenceCircle, FencePolygon, RallyPoint, circle, degrees, survey, transects

UP = 10.0
"""Height of most flights above home [m]."""


def copter_drafts() -> dict[str, Draft]:
    """Each by its name."""
    return {
        "square": copter("A square of 20 m at 10 m, landing at its first corner")
        .take_off(UP).to((20, 0), (20, 20), (0, 20), (0, 0), z=UP).land(),
        "square_return": copter("A square of 15 m with a second at each corner, then return to launch", text=True)
        .take_off(UP).to((15, 0), (15, 15), (0, 15), (0, 0), z=UP, wait=1.0).home(),
        "triangle": copter("Three long legs whose corners are cut without a stop", text=True)
        .take_off(UP).to((40, 0), (20, 34.6), (0, 0), z=UP).land(),
        "figure_eight": copter("Two circles of twelve waypoints each, one to the left and one to the right")
        .take_off(UP).pace(4.0)
        .to(*circle((0, 12), 12, 12, 270)[1:], *[(n, -e) for n, e in circle((0, 12), 12, 12, 270)], z=UP).land(),
        "spline_figure": copter("An eight of spline waypoints, climbing and falling, entered along a straight leg")
        .take_off(UP).pace(4.0).to((10, 0), z=UP)
        .curve((25, 10, 12), (40, 0, 14), (25, -10, 12), (10, 0, 10))
        .curve((-5, 10, 8), (-20, 0, 8), (-5, -10, 9), (10, 0, 10))
        .to((20, 0), z=UP).land(),
        "survey": copter("A survey of a field of 40 m by 30 m, its lines 8 m apart and turned by 20 degrees")
        .take_off(15).complex(survey([(10, -15), (50, -15), (50, 15), (10, 15)], 20.0, transects(8.0, 15.0, 3.0)))
        .home(),
        "corridor": copter("A corridor of three places, 12 m wide, flown on three lines")
        .take_off(UP).complex({
            "CorridorWidth": 12.0,
            "EntryPoint": 0,
            "TransectStyleComplexItem": transects(5.0, UP, 2.0),
            "complexItemType": "CorridorScan",
            "polyline": [list(degrees(*p)) for p in ((5, 5), (30, 10), (45, 35))],
            "version": 2,
        }).home(),
        "structure": copter("Round a tower of 8 m by 8 m at a distance of 5 m, three layers from the bottom up")
        .take_off(6).complex({
            "CameraCalc": {"AdjustedFootprintFrontal": 4.0, "AdjustedFootprintSide": 4.0, "DistanceToSurface": 5.0,
                           "CameraName": "Manual (no camera specs)", "DistanceMode": 1, "version": 2},
            "EntranceAltitude": 18.0,
            "GimbalPitch": 0,
            "Layers": 3,
            "ScanBottomAlt": 3.0,
            "StartFromTop": False,
            "StructureHeight": 15.0,
            "complexItemType": "StructureScan",
            "polygon": [list(degrees(*p)) for p in ((20, -4), (28, -4), (28, 4), (20, 4))],
            "version": 3,
        }).home(),
        "delivery": copter("Two places served: down to 2 m, wait 5 s, up again, on; then home")
        .take_off(UP).pace(6.0).to((30, 0), z=UP).to((30, 0), z=2.0).add(MavCmd.NAV_DELAY, 5, -1, -1, -1)
        .to((30, 0), (15, 25), z=UP).to((15, 25), z=2.0).add(MavCmd.NAV_DELAY, 5, -1, -1, -1).to((15, 25), z=UP).home(),
        "jump_loop": copter("To and fro three times by a jump, then land", text=True)
        .take_off(UP).to((15, 0), (0, 0), z=UP).jump(2, 2).land(),
        "nested_jumps": copter("A short loop within a longer one, each flown twice")
        .take_off(UP).to((12, 0), (12, 8), z=UP).jump(2, 1).to((0, 8), (0, 0), z=UP).jump(2, 1).land(),
        "circles": copter("Two turns clockwise on 8 m, one counter-clockwise on 6 m")
        .take_off(UP).add(MavCmd.NAV_LOITER_TURNS, 2, 0, 8, 1, at=(20, 0), z=UP)
        .add(MavCmd.NAV_LOITER_TURNS, 1, 0, -6, 1, at=(20, 25), z=12.0).home(),
        "loiter_times": copter("Stays of 3, 5 and 2 seconds at three places", text=True)
        .take_off(UP).add(MavCmd.NAV_LOITER_TIME, 3, at=(15, 0), z=UP)
        .add(MavCmd.NAV_LOITER_TIME, 5, at=(15, 15), z=8.0)
        .add(MavCmd.NAV_LOITER_TIME, 2, at=(0, 15), z=UP).home(),
        "speed_changes": copter("Legs of 30 m at 2, 4, 8 and 3 m/s, climbs at 1 and 2 m/s")
        .take_off(UP).pace(2.0).to((30, 0), z=UP).pace(4.0).to((30, 30), z=UP)
        .add(MavCmd.DO_CHANGE_SPEED, 2, 1.0, -1).to((30, 30), z=15.0).pace(8.0).to((0, 30), z=15.0).pace(3.0)
        .add(MavCmd.DO_CHANGE_SPEED, 3, 1.0, -1).to((0, 0), z=UP).land(),
        "yaw": copter("Headings on the way: absolute, relative both ways, at several rates")
        .take_off(UP).pace(3.0).to((10, 0), z=UP).add(MavCmd.CONDITION_YAW, 90, 30, 1, 0).to((25, 0), z=UP)
        .add(MavCmd.CONDITION_YAW, 60, 20, -1, 1).to((25, 20), z=UP).add(MavCmd.CONDITION_YAW, 45, 45, 1, 1)
        .to((0, 20), z=UP)
        .land(),
        "region_of_interest": copter("Round a place that the nose looks at, then without")
        .take_off(UP).pace(4.0).add(MavCmd.DO_SET_ROI_LOCATION, at=(20, 0))
        .to(*circle((20, 0), 12, 6, 180), z=UP).add(MavCmd.DO_SET_ROI_NONE).to((0, 0), z=UP).land(),
        "conditions": copter("Commands held back by a distance and by a time")
        .take_off(UP).pace(2.0).to((15, 0), z=UP).add(MavCmd.CONDITION_DISTANCE, 10)
        .add(MavCmd.CONDITION_YAW, 90, 30, 1, 0)
        .to((40, 0), z=UP).add(MavCmd.CONDITION_DELAY, 3).pace(5.0).to((40, 25), z=UP).land(),
        "stairs": copter("Up and down in steps: heights above home, above mean sea level and above terrain")
        .take_off(5).to((8, 0, 8), (16, 0, 12)).to((24, 0, 600), frame=MavFrame.GLOBAL)
        .to((24, 12, 10), (16, 12, 6), frame=MavFrame.GLOBAL_TERRAIN_ALT).to((0, 12, 4)).land(),
        "spiral": copter("Two turns of a spiral that climbs from 5 m to 20 m and widens to 15 m")
        .take_off(5).pace(4.0)
        .to(*[((5 + 10 * k / 20) * cos(math.radians(36 * k)), (5 + 10 * k / 20) * sin(math.radians(36 * k)),
               5 + 15 * k / 20) for k in range(21)])
        .home(),
        "slalom": copter("Six gates left and right of a straight line, at 5 m/s")
        .take_off(5).pace(5.0)
        .to(*[(8 * (k + 1), 6 - 12 * (k % 2)) for k in range(6)], z=5.0).to((56, 0), z=5.0).land(),
        "fence_and_rally": copter("A square within a circle and a polygon, with a keep-out circle and a rally point")
        .take_off(UP).to((15, 0), (15, 15), (0, 15), z=UP).home()
        .fence(
            circles=(FenceCircle(degrees(0, 0), 80.0), FenceCircle(degrees(40, 40), 5.0, inclusion=False)),
            polygons=(FencePolygon(tuple(degrees(*p) for p in ((-50, -50), (60, -50), (60, 60), (-50, 60)))),),
            rally=(RallyPoint(degrees(-10, 0), 15.0),),
        ),
        "photo_points": copter("Four places with a picture at each: camera commands, for a camera (CAM1_TYPE)")
        .take_off(UP).to((12, 0), z=UP, wait=1.0).add(MavCmd.IMAGE_START_CAPTURE, 0, 0, 1)
        .to((12, 12), z=UP, wait=1.0).add(MavCmd.IMAGE_START_CAPTURE, 0, 0, 1)
        .to((0, 12), z=UP, wait=1.0).add(MavCmd.DO_DIGICAM_CONTROL).to((0, 0), z=UP, wait=1.0).land(),
        "office_route": copter(
            "Through the office at 1.2 m, over a wall into the next room, and back", world="office_erlecopter"
        ).take_off(1.2).pace(1.5).to((0, 8), (-1.5, 1), (-9, -1), (-13, 1), z=1.2).to((-13, 1), (-19.5, 1.5), z=4.0)
        .to((-19.5, 1.5), z=1.2, wait=3.0).to((-19.5, 1.5), (-11, 3), z=4.0).to((-11, 3), (-1, 1), z=1.2).land(),
    }  # fmt: skip


def copter(description: str, *, text: bool = False, frame: str = "erle_copter", **index: str) -> Draft:
    """An empty mission."""
    return Draft("copter", description, text=text, frame=frame, **index)


MAZE = (
    (8, -3), (4, -9), (-9, -8), (-11, 7), (-2, 14), (-5, 19), (-10, 22), (-5, 28), (16, 26),
    (20, 19), (26, 15), (24, 1), (18, -4), (21, -9), (34, -8), (37, 18), (43, 19), (47, -8),
    (72, -8), (73, -2), (64, 4), (62, 19), (56, 23), (58, 28), (73, 30), (73, 38),
)  # fmt: skip
"""Through maze_erlerover from its start to its exit, 2.9 m or more from every wall."""


def rover_drafts() -> dict[str, Draft]:
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
        .to(*[(10 * (k + 1), 4 - 8 * (k % 2)) for k in range(5)], (60, 0)),
        "figure_eight": rover("Two circles of eight waypoints each, one to the left and one to the right")
        .to(*circle((0, 8), 8, 8, 270)[1:], *[(n, -e) for n, e in circle((0, 8), 8, 8, 270)]),
        "reverse": rover("Forwards, 10 m backwards, forwards again")
        .to((15, 0)).add(MavCmd.DO_SET_REVERSE, 1).to((5, 0)).add(MavCmd.DO_SET_REVERSE, 0).to((20, 8)),
        "speed_changes": rover("Legs of 15 m at 0.5, 1.2 and 0.8 m/s", text=True)
        .pace(0.5).to((12, 0)).pace(1.2).to((12, 15)).pace(0.8).to((0, 15)),
        "delivery": rover("Stops of 4, 6 and 2 seconds at three places, and home")
        .to((15, 0), wait=4.0).to((15, 12)).add(MavCmd.NAV_DELAY, 6, -1, -1, -1).to((0, 12), wait=2.0).home(),
        "jump_loop": rover("A triangle driven twice by a jump", text=True)
        .to((12, 0), (12, 12), (0, 0)).jump(1, 1),
        "circles": rover("Two turns on a circle of 5 m").to((6, 0)).add(MavCmd.NAV_LOITER_TURNS, 2, 0, 5, at=(12, 0)),
        "loiter_times": rover("Stays of 5 and 3 seconds")
        .add(MavCmd.NAV_LOITER_TIME, 5, at=(10, 0)).add(MavCmd.NAV_LOITER_TIME, 3, at=(10, 10)),
        "headings": rover("Turns to headings at a walking speed, between two places")
        .to((8, 0)).add(MavCmd.NAV_SET_YAW_SPEED, 90, 0.8, 0).add(MavCmd.NAV_SET_YAW_SPEED, 90, 0.8, 1).to((0, 10)),
        "mowing": rover("A meadow of 24 m by 20 m, in lines 5 m apart")
        .complex(survey([(4, 4), (28, 4), (28, 24), (4, 24)], 0.0, transects(5.0, 0.0), 2)).home(),
        "return_home": rover("Out and back by return to launch").to((15, 5), (20, 15)).home(),
        "maze_route": rover("Through the maze to its exit", world="maze_erlerover").to(*MAZE),
    }  # fmt: skip


def rover(description: str, *, text: bool = False, frame: str = "erle_rover", **index: Any) -> Draft:
    """An empty mission."""
    return Draft("rover", description, text=text, frame=frame, **index)
