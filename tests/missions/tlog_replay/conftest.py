# SPDX-License-Identifier: BSD-3-Clause
"""Logs as ground stations write them; one log, made once."""

from __future__ import annotations

import struct
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest

from benchmarks.recorded.pilot import Pilot, items
from sitl.bridge.dialect import message
from sitl.bridge.frame import encode_v2
from sitl.logs.tlog import read_tlog
from sitl.missions.tlog_replay.extract import Script, extract
from sitl.missions.tlog_replay.log import Log
from sitl.run import runner
from sitl.simulation import Core, Simulation


@pytest.fixture(scope="session")
def flight_log(core: Core, tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The log of a copter's mission."""
    return fly_mission(tmp_path_factory.mktemp("logged"), core)


HOME = (47.3977, 8.5456, 488.0, 40.0)


def north(metres: float) -> int:
    """Latitude so far north of home [degE7]."""
    return round((HOME[0] + metres / 111_320.0) * 1e7)


ITEMS = [
    (0, 16, north(0), round(HOME[1] * 1e7), 488.0),
    (3, 22, 0, 0, 5.0),
    (3, 16, north(12), round(HOME[1] * 1e7), 5.0),
    (3, 16, north(4), round(HOME[1] * 1e7), 6.0),
    (3, 21, 0, 0, 0.0),
]


def fly_mission(folder: Path, core: Core, system: int = 1) -> Path:
    """A copter that is given a mission, flies it and lands; the log of its ground station."""
    simulation = Simulation("erle_copter", home=HOME, seed=4, core=core, params={"MAV_SYSID": float(system)})
    log = runner.open_log(simulation, folder, "flight")
    pilot = Pilot(simulation)
    pilot.fly(45.0)
    pilot.send("PARAM_SET", param_id=b"WPNAV_SPEED", param_value=300.0, param_type=9)
    pilot.transfer(items(ITEMS))
    pilot.send_command("DO_SET_MODE", 1, 4)
    pilot.fly(0.5)
    pilot.send_command("COMPONENT_ARM_DISARM", 1)
    pilot.fly(2.0)
    pilot.send_command("DO_SET_MODE", 1, 3)
    pilot.send_command("MISSION_START")
    pilot.fly(2.0)
    assert pilot.armed
    assert pilot.fly(90.0, lambda: not pilot.armed)
    pilot.fly(2.0)
    simulation.close()
    return log


def frame(name: str, system: int = 1, component: int = 1, **fields: Any) -> bytes:
    """One frame."""
    kind = message(name)
    return encode_v2(kind, kind.payload(**fields), 0, system, component)


def write(path: Path, rows: list[tuple[float, bytes]]) -> Path:
    """A log of frames at times [s]."""
    path.write_bytes(b"".join(struct.pack(">Q", 1_700_000_000_000_000 + round(t * 1e6)) + raw for t, raw in rows))
    return path


def rows(path: Path) -> list[tuple[float, bytes]]:
    """The frames of a log."""
    found = list(read_tlog(path))
    return [((stamp - found[0][0]) * 1e-6, raw) for stamp, raw in found]


def system_of(raw: bytes) -> int:
    """Who sent a frame."""
    return raw[5]


Extract = Callable[..., Script]


def beat(time: float, armed: bool = False, mode: int = 0) -> tuple[float, bytes]:
    return time, frame("HEARTBEAT", type=2, autopilot=3, base_mode=128 * armed, custom_mode=mode)


MODE = 0.5, frame("COMMAND_LONG", 255, 190, target_system=1, command=176, param1=1.0, param2=4.0)
"""With it the log has commands: nothing is taken from what the vehicle says."""


@pytest.fixture
def script(tmp_path: Path) -> Extract:
    def of(*rows: tuple[float, bytes], begins: tuple[tuple[float, bytes], ...] = (beat(0.0), MODE)) -> Script:
        made = sorted((*begins, *rows), key=lambda row: row[0])
        return extract(Log(write(tmp_path / "made.tlog", made)))

    return of
