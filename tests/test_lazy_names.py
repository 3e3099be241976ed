# SPDX-License-Identifier: BSD-3-Clause
"""``import sitl``: offers what a user starts from, and loads it when it is first used."""

from __future__ import annotations

import os
import subprocess
import sys

import pytest

import sitl
from sitl import vehicles, worlds
from sitl.simulation import Simulation


def test_every_name_is_there() -> None:
    assert sitl.Simulation is Simulation
    assert sitl.vehicle_names is vehicles.names and "erle_copter" in sitl.vehicle_names()
    assert sitl.world_names is worlds.names and "maze" in sitl.world_names()
    assert set(sitl.__all__) <= set(dir(sitl)) and all(hasattr(sitl, name) for name in sitl.__all__)


def test_another_name_is_refused() -> None:
    with pytest.raises(AttributeError, match=r"no attribute 'simulation_of'; it has Simulation, "):
        sitl.simulation_of  # noqa: B018


def test_importing_it_loads_nothing_else() -> None:
    code = "import sys, importlib, typing; before = set(sys.modules); import sitl; dir(sitl); "
    code += "print(sorted(set(sys.modules) - before))"
    environment = {**os.environ, "PYTHONPATH": os.pathsep.join(sys.path)}
    done = subprocess.run([sys.executable, "-c", code], env=environment, capture_output=True, text=True)
    assert done.stdout == "['sitl']\n", done.stderr
