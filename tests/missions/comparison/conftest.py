# SPDX-License-Identifier: BSD-3-Clause
"""Flights for the tests of comparisons, flown once."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest

from sitl.autopilot.mission.item import MissionItem
from sitl.autopilot.mission.mission import Mission
from sitl.logs.track import Track
from sitl.missions import library
from sitl.missions.comparison.flight import Flight, read
from sitl.missions.files import load
from sitl.missions.fly import fly
from sitl.recording.recorder import Recorder
from sitl.run import runner
from sitl.simulation import Simulation


@pytest.fixture(scope="session")
def squares(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A folder with a copter's and a rover's flight as .rec, .tlog and .bin each."""
    folder = tmp_path_factory.mktemp("squares")
    for kind in ("copter", "rover"):
        fly_square(folder / f"{kind}.rec", kind, logs=True)
    return folder


Change = Callable[[tuple[MissionItem, ...]], tuple[MissionItem, ...]]


def fly_square(
    path: Path,
    kind: str = "copter",
    *,
    seed: int = 1,
    params: dict[str, float] | None = None,
    change: Change = lambda items: items,
    logs: bool = False,
) -> Flight:
    """The library's square, recorded at ``path``; with ``logs``, .tlog and .bin beside it."""
    entry = library.find(f"{kind}/square")
    simulation = Simulation(entry.frame, seed=seed, params={**entry.params, **(params or {})})
    try:
        Recorder(simulation, path)
        if logs:
            runner.open_log(simulation, path.parent, path.stem)
        mission = load(entry.path).mission
        assert fly(simulation, Mission(change(mission.items))).completed
    finally:
        simulation.close()
    return read(path)


def straight(seconds: float = 20.0, speed: float = 2.0, wait: float = 0.0) -> Track:
    """North for half of the time, then east, after a wait; armed and AUTO at 0."""
    t = np.arange(0.0, seconds + wait + 0.05, 0.1)
    going = np.clip(t - wait, 0.0, seconds)
    half = seconds / 2.0
    data = np.zeros((len(t), 11))
    data[:, 0] = t
    data[:, 1] = speed * np.minimum(going, half)
    data[:, 2] = speed * np.maximum(going - half, 0.0)
    data[:, 3] = -10.0
    data[:, 4] = speed * ((going > 0.0) & (going < half))
    data[:, 5] = speed * ((going >= half) & (going < seconds))
    return Track(
        "copter",
        data,
        (-35.0, 149.0, 584.0),
        [(0.0, "AUTO")],
        [(wait + half, 1), (wait + seconds, 2)],
        [(1.0, 6, "Mission: 1 WP"), (wait + half, 6, "Reached command #1")],
        [(0.0, True)],
    )
