# SPDX-License-Identifier: BSD-3-Clause
"""Limits of an agent on a vehicle that may be real: their usual values, their edges, when it is not in charge."""

from __future__ import annotations

import math
from pathlib import Path
from typing import Any

import pytest

from sitl.envs import EnvOptionError
from sitl.envs.actions import ACCELERATION, ATTITUDE, POSITION, VELOCITY
from sitl.envs.mavlink.guard import AHEAD_S, BEYOND, BRAKING, Guard, Watch, append, guard_of

HERE = (0.0, 0.0, 5.0, 0.0)


class Clock:
    def __init__(self) -> None:
        self.now = 100.0

    def __call__(self) -> float:
        return self.now


def watch(flies: bool = True, clock: Any = None, **limits: Any) -> Watch:
    made = Watch(Guard(**limits), flies, clock or Clock())
    made.take_over(0.0, HERE[:3])
    return made


def test_without_a_word_limits_are_those_of_a_careful_pilot() -> None:
    """A vehicle that may be real is held by these: who changes one changes what agents may do to it."""
    found = Guard()
    assert (found.radius, found.floor, found.ceiling) == (50.0, 1.0, 30.0)
    assert (found.speed, found.climb, found.acceleration, found.late) == (3.0, 1.5, 2.0, 1.0)
    assert math.degrees(found.tilt) == pytest.approx(20.0, abs=0.1) and (found.hand_over, found.log) == ("", None)
    assert guard_of(None, False) == found and guard_of(None, True) is None is guard_of(False, False)
    assert guard_of({"speed": 1.0}, True) == Guard(speed=1.0) and guard_of(found, True) is found


@pytest.mark.parametrize("name", ["radius", "ceiling", "speed", "climb", "tilt", "acceleration", "late"])
@pytest.mark.parametrize("value", [0.0, -1.0, math.inf, math.nan, "1", None])
def test_limits_are_above_zero_and_finite(name: str, value: Any) -> None:
    with pytest.raises(EnvOptionError, match=rf"Guard\({name}=.*; it must be above 0"):
        Guard(**{"floor": -9.0, name: value})


def test_floors_may_be_below_the_ground_and_are_below_ceilings() -> None:
    assert Guard(floor=-5.0).floor == -5.0 and Guard(floor=29.9).floor == 29.9
    for value in (math.nan, math.inf, -math.inf):
        with pytest.raises(EnvOptionError, match=r"Guard\(floor=.*; it must be finite"):
            Guard(floor=value)
    with pytest.raises(EnvOptionError, match="the floor must be the lower one"):
        Guard(floor=30.0)


@pytest.mark.parametrize("option", [True, 3, "on", [1]])
def test_options_that_are_no_guard_are_named(option: Any) -> None:
    with pytest.raises(EnvOptionError, match="it must be a Guard, its arguments, False, or None"):
        guard_of(option, False)
    with pytest.raises(EnvOptionError, match=r"guard: .*there are radius, floor, ceiling"):
        guard_of({"sped": 1.0}, False)


# ---------------------------------------------------------------- doubts


@pytest.mark.parametrize(("waited", "late"), [(0.5, False), (1.0, False), (1.01, True)])
def test_an_agent_is_late_after_a_second(waited: float, late: bool) -> None:
    clock = Clock()
    found = watch(clock=clock)
    assert found.doubt(HERE, (0.0,)) == "", "before its first step it has all the time"
    found.stepped()
    clock.now += waited
    told = found.doubt(HERE, (0.0,))
    assert bool(told) == late and (not late or told == "the agent is late: 1.01 s since its last step")


@pytest.mark.parametrize("number", [math.nan, math.inf, -math.inf])
def test_a_set_point_is_a_number(number: float) -> None:
    assert watch().doubt(HERE, (0.0, number)).startswith("a set-point is no number: [0.0, ")


@pytest.mark.parametrize(
    ("pose", "told"),
    [
        ((50.0 + BEYOND, 0.0, 5.0), ""), ((0.0, -50.1 - BEYOND, 5.0), "outside of the fence: 52.1 m away"),
        ((0.0, 0.0, 29.9 + BEYOND), ""), ((0.0, 0.0, 30.0 + BEYOND), "outside of the fence: at a height of 32.0 m"),
        ((0.0, 0.0, 1.1 - BEYOND), ""), ((0.0, 0.0, 1.0 - BEYOND), "outside of the fence: at a height of -1.0 m"),
    ],
)  # fmt: skip
def test_two_metres_beyond_the_fence_the_agent_has_lost_it(pose: Any, told: str) -> None:
    assert watch().doubt((*pose, 0.0), (0.0,)) == told
    assert watch(flies=False).doubt((*pose, 0.0), (0.0,)) == ("" if "height" in told else told)


def test_the_fence_is_about_the_first_position() -> None:
    found = watch()
    found.give_up("a pilot")
    assert (found.in_charge, found.reason) == (False, "a pilot")
    found.take_over(9.0, (40.0, 0.0, 5.0))
    assert found.in_charge and found.reason == ""
    assert found.doubt((53.0, 0.0, 5.0, 0.0), (0.0,)) != "" == found.doubt((51.0, 0.0, 5.0, 0.0), (0.0,))
    assert [deed.what for deed in found.deeds] == ["taken over", "taken over"]


# ---------------------------------------------------------------- set-points


def kept(setpoint: Any, row: Any, pose: Any = HERE, **limits: Any) -> list[float]:
    return watch(**limits).limited(setpoint, row, pose, 1.0)


def stops_at(clearance: float) -> float:
    """The speed that, kept for three seconds and braked then, ends so far away."""
    speed = BRAKING * (math.sqrt(AHEAD_S**2 + 2.0 * clearance / BRAKING) - AHEAD_S)
    assert AHEAD_S * speed + speed**2 / (2.0 * BRAKING) == pytest.approx(clearance)
    return speed


@pytest.mark.parametrize("yaw", [0.0, 1.0, math.pi])
def test_velocities_keep_their_direction(yaw: float) -> None:
    found = kept(VELOCITY, (6.0, 8.0, 0.5, 9.0), (0.0, 0.0, 15.0, yaw))
    assert found == pytest.approx([1.8, 2.4, 0.5, 9.0])
    assert kept(VELOCITY, (1.0, -2.0, 0.0, 0.0), (0.0, 0.0, 15.0, yaw)) == pytest.approx([1.0, -2.0, 0.0, 0.0])


@pytest.mark.parametrize(("up", "kept_up"), [(1.5, 1.5), (2.0, 1.5), (-2.0, -1.5)])
def test_climbs_have_an_end(up: float, kept_up: float) -> None:
    assert kept(VELOCITY, (0.0, 0.0, up, 0.0), (0.0, 0.0, 15.0, 0.0))[2] == kept_up


@pytest.mark.parametrize(
    ("height", "up", "wanted"),
    [(29.0, 1.5, stops_at(1.0)), (2.0, -1.5, -stops_at(1.0)), (31.0, 0.0, -1.0), (0.5, 0.0, 0.5), (1.0, -1.0, 0.0),
     (30.0, 1.0, 0.0)],
)  # fmt: skip
def test_near_floor_and_ceiling_it_slows_and_beyond_it_comes_back(height: float, up: float, wanted: float) -> None:
    pose = (0.0, 0.0, height, 0.0)
    assert kept(VELOCITY, (0.0, 0.0, up, 0.0), pose)[2] == pytest.approx(wanted)
    assert kept(VELOCITY, (0.0, 0.0, up, 0.0), pose, flies=False)[2] == up


@pytest.mark.parametrize("yaw", [0.0, math.pi / 2])
def test_near_the_fence_only_what_goes_outwards_is_less(yaw: float) -> None:
    c, s = math.cos(yaw), math.sin(yaw)
    pose = (49.0, 0.0, 15.0, yaw)
    outward, along = (2.0 * c, -2.0 * s), (2.0 * s, 2.0 * c)
    found = kept(VELOCITY, (*outward, 0.0, 0.0), pose)
    assert math.hypot(*found[:2]) == pytest.approx(stops_at(1.0))
    assert kept(VELOCITY, (*along, 0.0, 0.0), pose)[:2] == pytest.approx(list(along))
    back = kept(VELOCITY, (-2.0 * c, 2.0 * s, 0.0, 0.0), pose)
    assert back[:2] == pytest.approx([-2.0 * c, 2.0 * s])
    found = kept(VELOCITY, (0.0, 0.0, 0.0, 0.0), (51.0, 0.0, 15.0, yaw))
    assert found[:2] == pytest.approx([-c, s]), "outside of it, back by a metre a second"


def test_positions_are_within_the_fence() -> None:
    assert kept(POSITION, (60.0, 80.0, 99.0, 0.5)) == pytest.approx([30.0, 40.0, 30.0, 0.5])
    assert kept(POSITION, (3.0, 4.0, 0.0, 0.5)) == pytest.approx([3.0, 4.0, 1.0, 0.5])
    assert kept(POSITION, (0.0, 0.0, 99.0, 0.5), flies=False)[2] == 99.0


def test_leans_and_accelerations_have_ends_on_both_sides() -> None:
    assert kept(ATTITUDE, (1.0, -1.0, 9.0, 9.0)) == [0.35, -0.35, 9.0, 9.0] and kept(ATTITUDE, (0.3, -0.3)) == [
        0.3,
        -0.3,
    ]
    assert kept(ACCELERATION, (5.0, -5.0, 3.0, 9.0)) == [2.0, -2.0, 2.0, 9.0]
    assert kept(ACCELERATION, (0.0, 0.0, -3.0, 9.0)) == [0.0, 0.0, -2.0, 9.0]


def test_what_was_limited_is_noted_once_until_it_is_not() -> None:
    found = watch()
    for lean in (1.0, 2.0, 0.1, 1.0):
        found.limited(ATTITUDE, (lean, 0.0), HERE, 3.0)
    told = [deed for deed in found.deeds if deed.what == "limited"]
    assert len(told) == 2 and told[0] == (3.0, "limited", "attitude [1.0, 0.0] to [0.35, 0.0]")


# ---------------------------------------------------------------- its log


def test_lines_are_added_to_a_log(tmp_path: Path) -> None:
    path = tmp_path / "guard.log"
    append(path, "a\n")
    append(path, "")
    append(path, "b\n")
    assert path.read_text() == "a\nb\n"
    found = watch(log=path)
    found.note(1.23456, "put down", "it is low")
    assert path.read_text().splitlines()[-1] == '{"time": 1.235, "what": "put down", "why": "it is low"}'
    with pytest.raises(OSError):
        append(tmp_path / "none" / "guard.log", "a")


def test_a_log_that_is_lost_is_told_once(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    found = watch(log=tmp_path / "none" / "guard.log")
    for _ in range(3):
        found.note(1.0, "put down", "")
    assert [deed.what for deed in found.deeds] == ["taken over", "log lost", "put down", "put down", "put down"]
    assert (
        capsys.readouterr().err.count("cannot be written: No such file or directory; the flight goes on without it")
        == 1
    )
