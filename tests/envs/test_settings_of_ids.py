# SPDX-License-Identifier: BSD-3-Clause
"""What an id means stays: results that were published with it are compared with new ones. Other settings are for an id
with another version.

``data/settings_of_ids.json`` has them as they were published; tables of moves are the same for all tasks of a robot, as
are limits of actions where an id has none of its own.
"""

from __future__ import annotations

import json
from collections.abc import Mapping
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from sitl.envs.ids import FIRST, NEW
from sitl.envs.presets import COPTER_MOVES, COPTER_MOVES_AMONG, PRESETS, ROVER_MOVES
from sitl.envs.robots.copter import ROBOT as COPTER
from sitl.envs.robots.rover import ROBOT as ROVER

PUBLISHED = json.loads((Path(__file__).parent / "data" / "settings_of_ids.json").read_text())
TRACK = "_given_gates"
ROBOTS: dict[str, Any] = {
    "copter": COPTER, "copter, PX4": COPTER.with_px4, "copter, Betaflight": COPTER.with_betaflight, "rover": ROVER,
}  # fmt: skip
KEPT = (
    "modes",
    "guided",
    "tick",
    "crash_range",
    "discrete",
    "continuous",
    "agile",
    "takes_off",
    "feels_wind",
    "parameters",
)
MOVES = {"copter": COPTER_MOVES, "copter among solids": COPTER_MOVES_AMONG, "rover": ROVER_MOVES}


def plain(value: Any) -> Any:
    """Settings as JSON has them: of an object its class and what its class keeps in public."""
    if isinstance(value, np.ndarray):
        return plain(value.tolist())
    if isinstance(value, float):
        return repr(value) if value in (np.inf, -np.inf) else round(value, 9)
    if value is None or isinstance(value, (bool, int, str)):
        return value
    if isinstance(value, Mapping):
        return {str(name): plain(inner) for name, inner in value.items()}
    if isinstance(value, (list, tuple)) and not hasattr(value, "_fields"):
        return [plain(inner) for inner in value]
    if hasattr(value, "columns") and hasattr(value, "only"):  # a kind of set-point
        return value.name
    kept = {name: inner for name, inner in getattr(value, "__dict__", {}).items() if name[0] != "_" or name == TRACK}
    kept.pop("space", None)
    return {"class": type(value).__name__, **plain(kept)}


@pytest.mark.parametrize("preset", sorted(PUBLISHED["presets"]))
def test_what_an_id_means_stays(preset: str) -> None:
    assert plain(PRESETS[preset]()) == PUBLISHED["presets"][preset]


def test_each_task_is_among_them_and_has_its_time() -> None:
    assert PUBLISHED["presets"].keys() == {name for name in PRESETS if "discrete" not in name}
    assert {name: listed.steps for name, listed in (FIRST | NEW).items()} == PUBLISHED["steps"]


@pytest.mark.parametrize("robot", MOVES)
def test_moves_stay(robot: str) -> None:
    assert plain(MOVES[robot]) == PUBLISHED["moves"][robot]
    assert list(MOVES[robot]) == list(PUBLISHED["moves"][robot]), "agents know them by their numbers"


@pytest.mark.parametrize("robot", ROBOTS)
def test_modes_and_limits_of_a_robot_stay(robot: str) -> None:
    """Where an id gives none of its own, they are what its actions mean."""
    kind = ROBOTS[robot]
    assert {name: plain(getattr(kind, name)) for name in KEPT} == PUBLISHED["robots"][robot]
