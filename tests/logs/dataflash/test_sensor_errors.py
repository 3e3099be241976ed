# SPDX-License-Identifier: BSD-3-Clause
"""ERR of sensors that fall silent, and of their return."""

from __future__ import annotations

from pathlib import Path

import pytest

from sitl import Simulation
from sitl.bridge.services.parameter_protocol import ParameterService
from sitl.run import runner
from sitl.simulation import Core
from tests.logs.dataflash.conftest import read_log

BARO, COMPASS, UNHEALTHY, HEALTHY = 18, 3, 4, 0
BAROS = ("SIM_BARO_DISABLE", "SIM_BAR2_DISABLE")
COMPASSES = ("SIM_MAG1_FAIL", "SIM_MAG2_FAIL", "SIM_MAG3_FAIL")


def test_a_sensor_that_falls_silent_is_an_error_until_it_is_back(core: Core, tmp_path: Path) -> None:
    simulation = Simulation("ardupilot_quad", core=core, params={"LOG_DISARMED": 1})
    runner.open_dataflash(simulation, tmp_path / "a.bin")
    simulation.advance(12.0)
    parameters = simulation.bridge.get(ParameterService)
    for names in (BAROS, COMPASSES):
        for value in (1.0, 0.0):
            for name in names:
                parameters.set(name, value)
            simulation.advance(2.0)
    simulation.close()
    errors = [(m.Subsys, m.ECode, m.TimeUS * 1e-6) for m in read_log(tmp_path / "a.bin")["ERR"]]
    sensors = [each for each in errors if each[0] in (BARO, COMPASS)]
    kinds = [(BARO, UNHEALTHY), (BARO, HEALTHY), (COMPASS, UNHEALTHY), (COMPASS, HEALTHY)]
    assert [each[:2] for each in sensors] == kinds
    assert [each[2] for each in sensors] == pytest.approx([12.55, 14.05, 16.55, 18.05], abs=0.1)
