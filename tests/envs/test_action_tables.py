# SPDX-License-Identifier: BSD-3-Clause
"""Commands and limits of actions by what they mean: sides mirror each other, limits are alike both ways, pulses are
pulses; and what an id's options become when a user gives others."""

from __future__ import annotations

import re
from typing import Any

import pytest

from sitl.envs import ids, presets
from sitl.envs.actions import Normalised
from sitl.envs.options import EnvOptionError
from sitl.envs.presets import COPTER_MOVES, COPTER_MOVES_AMONG, PRESETS, ROVER_MOVES, options_of
from sitl.envs.robots.copter import ROBOT as COPTER
from sitl.envs.robots.rover import ROBOT as ROVER

FORWARD, LEFT, UP, TURN = range(4)
KINDS = {"copter": COPTER, "rover": ROVER, "px4": COPTER.with_px4, "betaflight": COPTER.with_betaflight}
TABLES: dict[str, Any] = {
    "copter": COPTER_MOVES, "copter among solids": COPTER_MOVES_AMONG, "rover": ROVER_MOVES,
    "paper's copter": COPTER.discrete["velocity"], "paper's rover": ROVER.discrete["velocity"],
}  # fmt: skip


def mirrored(move: tuple[float, ...]) -> tuple[float, ...]:
    return (move[FORWARD], -move[LEFT], move[UP], -move[TURN])


@pytest.mark.parametrize("table", TABLES)
def test_left_and_right_mirror_each_other(table: str) -> None:
    moves = TABLES[table]
    for name, move in moves.items():
        if "left" in name:
            assert tuple(moves[name.replace("left", "right")]) == mirrored(move), name
            sides = (move[LEFT], move[TURN] * (-1.0 if "back" in name and "rover" in table else 1.0))
            assert max(sides) > 0.0 and min(sides) == 0.0, f"{name}: to the left, or counter-clockwise, and not both"
        elif "right" not in name:
            assert move[LEFT] == 0.0 == move[TURN], name


@pytest.mark.parametrize("table", TABLES)
def test_words_say_which_way(table: str) -> None:
    for name, move in TABLES[table].items():
        words = set(name.split())
        is_vertical = bool(words & {"up", "down"})
        assert (move[UP] > 0.0) == ("up" in words) and (move[UP] < 0.0) == ("down" in words), name
        if "forward" in words:
            assert move[FORWARD] > 0.0
        if "back" in words:
            assert move[FORWARD] < 0.0
        if words == {"stay"} or is_vertical:
            assert [move[FORWARD], move[LEFT], move[TURN]] == [0.0, 0.0, 0.0], name


@pytest.mark.parametrize("table", ["copter", "copter among solids"])
def test_copters_go_as_fast_each_way_and_diagonals_are_sums(table: str) -> None:
    moves = TABLES[table]
    fast, slow = moves["forward"][FORWARD], moves["slowly forward"][FORWARD]
    assert 0.0 < slow < fast
    for name, move in moves.items():
        words = set(name.split()) - {"turn"}
        speed = slow if "slowly" in words else fast
        if words & {"forward", "back"}:
            assert abs(move[FORWARD]) == speed, name
        elif not words & {"up", "down", "stay"}:
            assert move[FORWARD] == 0.0, name
        if words & {"left", "right"} and "turn" not in name:
            assert abs(move[LEFT]) == speed and move[TURN] == 0.0, name
    assert moves["up"][UP] == -moves["down"][UP] <= slow


def test_a_copter_among_solids_is_slower_and_turns() -> None:
    assert COPTER_MOVES_AMONG["forward"][FORWARD] < COPTER_MOVES["forward"][FORWARD]
    assert COPTER_MOVES_AMONG["turn left"][:TURN] == (0.0, 0.0, 0.0) and COPTER_MOVES_AMONG["turn left"][TURN] > 1.0
    assert {*COPTER_MOVES_AMONG} - {*COPTER_MOVES} == {"turn left", "turn right"}


OWN_BOXES = [name for name in PRESETS if isinstance(PRESETS[name]().get("action"), Normalised)]


@pytest.mark.parametrize("preset", OWN_BOXES)
def test_speeds_of_an_ids_own_box_are_alike_both_ways(preset: str) -> None:
    """None is faster than what is usual; among solids, where it has to stop within what it sees, it is slower."""
    box: Any = options_of(preset, {})["action"]
    usual, among = COPTER.agile["velocity"][1], "forest" in preset or "rooms" in preset
    assert box.setpoint.name == "velocity"
    for column, (low, high) in zip(box.columns, box.limits, strict=True):
        assert low == -high and 0.0 < high <= usual[column] and (high < usual[column] or not among or column == TURN)
    assert box.limits[FORWARD] == box.limits[LEFT]
    assert not among or box.limits[FORWARD][1] >= COPTER_MOVES_AMONG["forward"][FORWARD]


def test_copters_that_stop_among_solids_have_boxes_of_their_own() -> None:
    among = {f"copter-{world}{version}" for world in ("forest", "rooms") for version in ("", "-v1")}
    assert among <= set(OWN_BOXES)


@pytest.mark.parametrize("who", KINDS)
def test_set_points_are_alike_that_one_mode_and_one_parameter_take(who: str) -> None:
    kind: Any = KINDS[who]
    if kind is None:
        return
    for one in kind.modes:
        for other in kind.modes:
            same_mode = kind.modes[one] == kind.modes[other]
            same_parameter = kind.parameters.get(one) == kind.parameters.get(other)
            found = kind.are_alike(one, other)
            assert found is (same_mode and same_parameter) is kind.are_alike(other, one), (one, other)
        assert kind.are_alike(one, one) is True and kind.are_alike("", one) is False, "before the first, none"


def test_a_rover_drives_back_as_fast_and_steers_the_same_wheels() -> None:
    """Backwards with the wheels to the left it turns clockwise."""
    assert ROVER_MOVES["back"] == tuple(-x for x in ROVER_MOVES["forward"])
    for side in ("left", "right"):
        assert ROVER_MOVES[f"back {side}"] == tuple(-x for x in ROVER_MOVES[side]), side
    assert 0.0 < ROVER_MOVES["left"][FORWARD] < ROVER_MOVES["forward"][FORWARD] <= 1.5


LIMITS = [
    (f"{who} {part} {name}", name, limits)
    for who, kind in KINDS.items() if kind is not None
    for part in ("continuous", "agile") for name, limits in getattr(kind, part).items()
]  # fmt: skip


@pytest.mark.parametrize(("title", "name", "limits"), LIMITS, ids=[title for title, *_ in LIMITS])
def test_limits_are_alike_both_ways_but_for_shares_and_heights(title: str, name: str, limits: Any) -> None:
    low, high, columns = limits
    assert len(low) == len(high) == len(columns) == len(set(columns))
    for least, most, column in zip(low, high, columns, strict=True):
        if name in ("rc", "loiter"):
            assert least + most == 3000 and 1000 <= least < 1500, "pulses about 1500 us"
        elif name == "motors" or (name in ("thrust", "rates") and column == 3):
            assert (least, most) == (0.0, 1.0), "a share"
        elif name == "position" and column == UP:
            assert 0.0 < least < 1.0 and most == 100.0, "above the ground"
        else:
            assert least == -most < 0.0
    assert list(columns) == sorted(columns)


@pytest.mark.parametrize(("who", "kind"), [(who, kind) for who, kind in KINDS.items() if kind is not None])
def test_each_set_point_has_limits_for_its_columns(who: str, kind: Any) -> None:
    for setpoint in kind.setpoints:
        low, _, columns = kind.continuous[setpoint.name]
        assert max(columns) < len(setpoint.columns) and setpoint.name in kind.modes
        if who != "rover":
            assert len(low) in (4, 8)


@pytest.mark.parametrize("form", ["continuous", "agile", "discrete"])
@pytest.mark.parametrize("who", [who for who, kind in KINDS.items() if kind is not None])
def test_each_form_of_each_set_point_is_an_action(who: str, form: str) -> None:
    kind: Any = KINDS[who]
    for setpoint in kind.setpoints:
        if form == "discrete" and setpoint.name not in kind.discrete:
            with pytest.raises(EnvOptionError, match=f"no discrete actions for setpoint '{setpoint.name}'"):
                kind.action(form, setpoint)
            continue
        action = kind.action(form, setpoint)
        assert action.setpoint is setpoint
        if form == "discrete":
            assert action.space.n == len(kind.discrete[setpoint.name])
        else:
            limits = (kind.agile if form == "agile" else {}).get(setpoint.name, kind.continuous[setpoint.name])
            assert limits[2] == kind.continuous[setpoint.name][2], "agile or not, the same columns"
            assert action.space.high.tolist() == pytest.approx(limits[1]) and action.columns == list(limits[2])


@pytest.mark.parametrize("name", ["velocity", "attitude", "acceleration", "thrust", "rates"])
def test_agile_limits_are_wider(name: str) -> None:
    """But for shares, none is smaller, and one is larger."""
    usual, agile = COPTER.continuous[name][1], COPTER.agile[name][1]
    assert all(a >= u for a, u in zip(agile, usual, strict=True)) and agile != usual


@pytest.mark.parametrize("kind", [COPTER, ROVER])
def test_pulses_of_the_paper_mirror_each_other(kind: Any) -> None:
    """What is pressed is off the middle; channels that are not steered are released (0) or at rest."""
    moves = kind.discrete["rc"]
    left, right = moves["left"], moves["right"]
    for a, b in zip(left, right, strict=True):
        assert a == b or a + b == 3000
    assert left != right and all(len(row) == 8 for row in moves.values())


# ---------------------------------------------------------------- presets


def test_each_preset_has_a_discrete_one_with_the_moves_of_its_robot() -> None:
    for name in presets._CONTINUOUS:
        found, discrete = PRESETS[name](), PRESETS[f"{name}discrete"]()
        assert {k: repr(v) for k, v in discrete.items() if k not in ("action", "task", "observation", "start")} == {
            k: repr(v) for k, v in found.items() if k not in ("action", "task", "observation", "start")
        }
        wanted = ROVER_MOVES if name.startswith("rover") else COPTER_MOVES
        assert discrete["action"] == (COPTER_MOVES_AMONG if name in ("copter-forest", "copter-rooms") else wanted)
        assert found["step_time"] == (0.2 if name.startswith("rover") else 0.1)
        assert ("take_off" in found) == name.startswith("copter")


def test_second_versions_are_judged_by_the_truth_and_boot_as_often_as_usual() -> None:
    for name in presets._CONTINUOUS:
        first, second = PRESETS[name](), PRESETS[f"{name}-v1"]()
        assert (first["judge"], first["boots"]) == (presets.ESTIMATE, 1)
        assert second["judge"] == presets.TRUTH and "boots" not in second
        assert second["step_time"] == first["step_time"] and second["robot"] == first["robot"]


def test_first_versions_stay_in_one_world_where_second_ones_have_another_each_episode() -> None:
    for name in ("copter-forest", "copter-rooms", "rover-labyrinth", "rover-slalom", "rover-race", "rover-parking"):
        world = PRESETS[name]()["world"]
        assert re.fullmatch(r"\w+:seed=1(,\w+=\d+)*", world)
        assert PRESETS[f"{name}-v1"]()["world"] != world


@pytest.mark.parametrize(
    ("given", "changed"),
    [
        ({}, {}),
        ({"connection": "inprocess"}, {}),
        ({"connection": "tcp:127.0.0.1:5760"}, {"randomise": None}),
        ({"connection": "tcp:127.0.0.1:5760", "randomise": {"mass": (1, 2)}}, {"randomise": {"mass": (1, 2)}}),
        ({"setpoint": "velocity"}, {}),
        ({"judge": "estimate"}, {"judge": "estimate"}),
    ],
)
def test_options_that_are_given_replace_those_of_an_id(given: Any, changed: Any) -> None:
    usual, found = options_of("copter-hover", {}), options_of("copter-hover", given)
    for name, value in {**usual, **given, **changed}.items():
        assert repr(found[name]).split(" object")[0] == repr(value).split(" object")[0], name


def test_a_vehicle_elsewhere_stays_in_the_world_of_the_first_version() -> None:
    usual = options_of("copter-forest-v1", {})["world"]
    first = PRESETS["copter-forest"]()["world"]
    assert usual != first
    for given in ({"connection": "tcp:127.0.0.1:5760"}, {"gcs": 5760}, {"robot": lambda: None}):
        assert options_of("copter-forest-v1", given)["world"] == first
        assert options_of("copter-forest-v1", {**given, "world": "maze"})["world"] == "maze"
    for stays in ({"connection": "inprocess"}, {"robot": "erle_copter"}, {"gcs": None}):
        assert options_of("copter-forest-v1", stays)["world"] == usual


def test_a_box_for_one_kind_of_set_point_gives_way_to_the_usual_one_of_another() -> None:
    usual = options_of("copter-forest", {})["action"]
    assert isinstance(usual, Normalised) and usual.setpoint.name == "velocity"
    assert options_of("copter-forest", {"setpoint": "thrust"})["action"] == "normalised"
    assert isinstance(options_of("copter-forest", {"setpoint": "velocity"})["action"], Normalised)
    assert options_of("copter-hover", {"action": "continuous", "setpoint": "rc"})["action"] == "continuous"


def test_receivers_of_an_id_are_those_of_our_own_vehicles_in_process() -> None:
    name = next(name for name in presets._CONTINUOUS if "sensors" in PRESETS[f"{name}-v1"]())
    preset = f"{name}-v1"
    usual = options_of(preset, {})["sensors"]
    assert usual == options_of(preset, {"connection": "inprocess"})["sensors"]
    for given in ({"connection": "tcp:127.0.0.1:5760"}, {"robot": "erle_copter"}, {"frame": "ardupilot_quad"}):
        assert "sensors" not in options_of(preset, given)
        assert options_of(preset, {**given, "sensors": usual})["sensors"] == usual


def test_beacons_are_none_of_another_autopilots() -> None:
    for name in presets._CONTINUOUS:
        found = PRESETS[f"{name}-v1"]()
        if found.get("sensors") == "uwb":
            assert options_of(f"{name}-v1", {"autopilot": "px4"})["sensors"] == "rtk"
            assert options_of(f"{name}-v1", {"autopilot": "px4", "sensors": "uwb"})["sensors"] == "uwb"
            assert options_of(f"{name}-v1", {"autopilot": "native"})["sensors"] == "uwb"


def test_every_id_has_a_preset() -> None:
    assert {listed.preset for listed in (ids.FIRST | ids.NEW).values()} <= {*PRESETS}
