# SPDX-License-Identifier: BSD-3-Clause
"""Any mission that is taken, whatever happens meanwhile: numbers stay numbers, states stay known."""

from __future__ import annotations

import math

from hypothesis import given, settings
from hypothesis import strategies as st

from sitl.autopilot.mission.item import MissionItem, home_item
from sitl.autopilot.mission.mission import Mission
from sitl.autopilot.mission.validate import check, check_all
from sitl.autopilot.navigation.state import COMPLETE, RUNNING, STOPPED
from sitl.autopilot.rover import arming
from sitl.autopilot.rover.mission import COMMANDS
from sitl.autopilot.rover.modes.auto import AUTO
from sitl.autopilot.rover.modes.manual import MANUAL
from sitl.autopilot.rover.modes.set_mode import request
from sitl.core.mavlink import MavMissionResult
from tests.autopilot.rover.navigation.rover_on_mission import ORIGIN, Missionary

numbers = st.one_of(st.sampled_from([0.0, 1.0, -1.0, 3.0, 1e9, math.nan]), st.floats(width=32))
places = st.one_of(st.just(0), st.integers(-20000, 20000))
items = st.builds(
    lambda command, p1, p2, p3, p4, n, e: MissionItem(command, 3, p1, p2, p3, p4, ORIGIN[0] + n, ORIGIN[1] + e),
    st.sampled_from(sorted(COMMANDS.taken)), numbers, numbers, numbers, numbers, places, places,
).filter(lambda item: check(item, COMMANDS.taken) == MavMissionResult.ACCEPTED)  # fmt: skip
acts = st.sampled_from(["drive", "leave", "come back", "jump", "upload", "disarm", "arm", "clear", "faster"])


missions = st.lists(items, min_size=1, max_size=6).filter(  # jumps to items that are not there are refused
    lambda listed: check_all([home_item(*ORIGIN), *listed], COMMANDS.taken)[0] == MavMissionResult.ACCEPTED
)


@given(missions, st.lists(acts, max_size=8), st.booleans())
@settings(max_examples=40, deadline=None)
def test_any_mission(listed: list[MissionItem], happening: list[str], skid: bool) -> None:
    p = Missionary(**({"SERVO1_FUNCTION": 73.0, "SERVO3_FUNCTION": 74.0} if skid else {}))
    p.drive(*listed)
    assert p.sequencer is not None
    for act in ["drive", *happening]:
        if act == "leave":
            request(p.v, MANUAL, 2)
        elif act == "come back":
            request(p.v, AUTO, 2)
        elif act == "jump":
            p.sequencer.set_current(p.v, len(listed))
        elif act == "upload":
            p.sequencer.set_mission(p.v, Mission.of([home_item(*ORIGIN), *reversed(listed)]))
        elif act == "disarm":
            arming.disarm(p.v, 1, 0)
        elif act == "arm":
            arming.arm(p.v, 1, True)
        elif act == "clear" and p.sequencer.may_clear(p.v):
            p.sequencer.set_mission(p.v, Mission())
        elif act == "faster":
            p.sequencer.change_speed(p.v, 0, 7.0)
        p.run(0.4)
        nav = p.ap.modes.nav
        assert nav.mission_state in (STOPPED, RUNNING, COMPLETE)
        assert all(math.isfinite(value) for value in (*nav.pos[:2], *nav.vel[:2], *nav.target))
        drive = nav.drive
        assert all(math.isfinite(x) for x in (drive.desired_speed, drive.desired_turn_rate, drive.crosstrack))
        assert all(abs(float(c)) <= 1.0 for c in p.v.actuators.controls[:4])
