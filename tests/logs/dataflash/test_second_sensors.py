# SPDX-License-Identifier: BSD-3-Clause
"""What a log says of a second GPS receiver and a second barometer."""

from __future__ import annotations

from pathlib import Path

import pytest

from sitl import Simulation
from sitl.run import runner
from sitl.simulation import Core
from tests.logs.dataflash.conftest import read_log


def test_both_receivers_and_barometers_that_differ_are_logged(core: Core, tmp_path: Path) -> None:
    params = {"GPS2_TYPE": 1, "SIM_GPS2_ENABLE": 1, "LOG_DISARMED": 1}
    simulation = Simulation("ardupilot_quad", core=core, params=params)
    runner.open_dataflash(simulation, tmp_path / "a.bin")
    simulation.advance(15.0)
    simulation.fail("baro:2/wrong=20")
    simulation.fail("gps:1")
    simulation.advance(5.0)
    simulation.close()
    log = read_log(tmp_path / "a.bin")
    one, other = ([m for m in log["GPS"] if k == m.I] for k in (0, 1))
    assert len(other) == pytest.approx(len(one) + 25, abs=3), "the first one has been silent for five seconds"
    assert other[-1].Lat == pytest.approx(one[-1].Lat, abs=1e-5) and other[-1].Status == 6
    assert (other[0].U, other[-1].U, one[0].U) == (0, 1, 1)
    assert {m.I for m in log["GPA"]} == {0, 1}
    barometers = [[m for m in log["BARO"] if k == m.I] for k in (0, 1)]
    assert len(barometers[1]) == pytest.approx(50, abs=3), "while they differ, ten a second"
    assert barometers[1][-1].Alt - barometers[0][-1].Alt == pytest.approx(20.0, abs=0.5)
