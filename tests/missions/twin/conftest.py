# SPDX-License-Identifier: BSD-3-Clause
"""A log of our own, whose truth is known, made once; and small logs that are written here, message by message."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest

from sitl.autopilot.mission.item import MissionItem
from sitl.autopilot.mission.mission import Mission
from sitl.missions.fly import fly
from sitl.missions.twin import twin
from sitl.missions.twin.twin import Twin
from sitl.run.runner import open_dataflash
from sitl.simulation import Core, Simulation
from tests.logs.log_files import binary

HOME = (47.3977, 8.5456, 488.0, 40.0)
FRAME, SEED = "ardupilot_quad", 4
ITEMS = (
    MissionItem(16, 0, 0.0, 0.0, 0.0, 0.0, 473977000, 85456000, 488.0, 1),
    MissionItem(22, 3, 0.0, 0.0, 0.0, 0.0, 0, 0, 6.0, 1),
    MissionItem(16, 3, 0.0, 0.0, 0.0, 0.0, 473978000, 85456500, 6.0, 1),
    MissionItem(16, 3, 0.0, 0.0, 0.0, 0.0, 473977500, 85457500, 8.0, 1),
    MissionItem(21, 3, 0.0, 0.0, 0.0, 0.0, 0, 0, 0.0, 1),
)


@pytest.fixture(scope="session")
def own_log(core: Core, tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The on-board log of a short mission."""
    path = tmp_path_factory.mktemp("twin") / "own.bin"
    simulation = Simulation(FRAME, home=HOME, seed=SEED, core=core, params={"LAND_SPEED": 100.0})
    open_dataflash(simulation, path)
    try:
        assert fly(simulation, Mission(ITEMS)).completed
    finally:
        simulation.close()
    return path


@pytest.fixture(scope="session")
def own_twin(own_log: Path, core: Core) -> Twin:
    """Its twin, on the same airframe with the same seed."""
    return twin.fly(own_log, FRAME, seed=SEED, core=core)


FORMATS = {
    "MSG": ("QZ", "TimeUS,Message"),
    "PARM": ("QNff", "TimeUS,Name,Value,Default"),
    "MODE": ("QMBB", "TimeUS,Mode,ModeNum,Rsn"),
    "ARM": ("QBI", "TimeUS,ArmState,ArmChecks"),
    "POS": ("QLLfff", "TimeUS,Lat,Lng,Alt,RelHomeAlt,RelOriginAlt"),
    "ATT": ("Qffffff", "TimeUS,DesRoll,Roll,DesPitch,Pitch,DesYaw,Yaw"),
    "XKF1": ("QBffffff", "TimeUS,C,VN,VE,VD,PN,PE,PD"),
    "XKF2": ("QBff", "TimeUS,C,VWN,VWE"),
    "RCIN": ("QHHHHHH", "TimeUS,C1,C2,C3,C4,C5,C6"),
    "CMD": ("QHHHffffLLfB", "TimeUS,CTot,CNum,CId,Prm1,Prm2,Prm3,Prm4,Lat,Lng,Alt,Frame"),
    "MAVC": ("QBBBBBHffffiifBB", "TimeUS,TS,TC,SS,SC,Fr,Cmd,P1,P2,P3,P4,X,Y,Z,Res,WL"),
    "GUIP": ("QBfffbffffff", "TimeUS,Type,pX,pY,pZ,Terrain,vX,vY,vZ,aX,aY,aZ"),
}
Log = Callable[..., Path]


@pytest.fixture
def written(tmp_path: Path) -> Log:
    """Writes a log: ten seconds armed from 20 s on, a climb of 1 m/s to 5 m; ``more``: further messages, ``without``:
    names that are left out of the others, ``height``: of the climb [m], ``firmware``."""

    def write(
        *more: tuple[Any, ...],
        without: tuple[str, ...] = (),
        height: float = 5.0,
        firmware: str = "ArduCopter V4.5.7 (abc)",
        armed: bool = True,
    ) -> Path:
        rows: list[tuple[Any, ...]] = [("MSG", 1_000_000, firmware.encode())]
        rows += [("PARM", 1_000_000, b"WPNAV_SPEED", 400.0, 500.0), ("PARM", 1_000_000, b"SERVO1_FUNCTION", 33.0, 0.0)]
        rows += [("MODE", 2_000_000, 0, 0, 26)]
        if armed:
            rows += [("ARM", 20_000_000, 1, 0), ("ARM", 30_000_000, 0, 0)]
        for k in range(180, 301):
            t = 100_000 * k
            up = min(max(0.1 * (k - 210), 0.0), height)
            rows += [
                ("POS", t, 473977000, 85456000, 488.0 + up, up, up), ("ATT", t, 0.0, 0.0, 0.0, 0.0, 90.0, 90.0),
                ("XKF1", t, 0, 0.0, 0.0, -1.0, 3.0, 4.0, 0.5 - up), ("RCIN", t, 1500, 1500, 1000 + k, 1500, 1200, 0),
            ]  # fmt: skip
        rows = sorted((*(row for row in rows if row[0] not in without), *more), key=lambda row: row[1])
        path = tmp_path / "small.bin"
        path.write_bytes(binary(rows, {name: FORMATS[name] for name in FORMATS}))
        return path

    return write


def cut(path: Path, to: Path, share: float) -> Path:
    """The beginning of a file."""
    data = path.read_bytes()
    to.write_bytes(data[: int(share * len(data))])
    return to
