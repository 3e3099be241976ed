# SPDX-License-Identifier: BSD-3-Clause
"""Which outputs are motors, in the logs of several versions."""

from __future__ import annotations

from pathlib import Path

import pytest

from sitl.logs.dataflash import motors
from sitl.logs.dataflash.columns import Columns
from tests.logs.log_files import V36, binary, written

FORMATS = V36 | {"PARM": ("QNf", "TimeUS,Name,Value")}


def log(path: Path, *texts: str, **parameters: float) -> Columns:
    rows = [("MSG", 1_000_000, text.encode()) for text in ("ArduCopter V3.4.4", *texts)]
    rows += [("PARM", 1_000_000, name.encode(), value) for name, value in parameters.items()]
    return Columns(written(path / "x.bin", binary(rows, FORMATS)))


def test_motors_are_found_by_their_functions(tmp_path: Path) -> None:
    found = log(
        tmp_path, SERVO1_FUNCTION=34, SERVO2_FUNCTION=0, SERVO5_FUNCTION=33, FRAME_CLASS=1, FRAME_TYPE=0, FRAME=1
    )
    assert (motors.channels(found), motors.frame(found)) == ([5, 1], (1, 0))


def test_before_there_were_functions_the_first_outputs_are_motors(tmp_path: Path) -> None:
    assert motors.channels(log(tmp_path, "Frame: QUAD", FRAME=1)) == [1, 2, 3, 4]
    assert motors.frame(log(tmp_path, "Frame: HEXA", FRAME=1)) == (2, 1)
    unknown = log(tmp_path, FRAME=1)
    assert (motors.channels(unknown), motors.frame(unknown)) == ([], (0, 1))


@pytest.mark.parametrize(
    ("parameters", "known"),
    [
        ({"MOT_PWM_MIN": 1010.0, "MOT_PWM_MAX": 1990.0}, (1010.0, 1990.0)),
        ({"MOT_PWM_MIN": 0.0, "MOT_PWM_MAX": 0.0, "RC3_MIN": 1094.0, "RC3_MAX": 1934.0}, (1094.0, 1934.0)),
        ({"RCMAP_THROTTLE": 1.0, "RC1_MIN": 1113.0, "RC1_MAX": 1906.0}, (1113.0, 1906.0)),
        ({}, (1000.0, 2000.0)),
    ],
)
def test_pulses(parameters: dict[str, float], known: tuple[float, float]) -> None:
    assert motors.pulses(parameters) == known
