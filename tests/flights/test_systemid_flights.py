# SPDX-License-Identifier: BSD-3-Clause
"""SYSTEMID: the chirp, what answers it, what it tells and logs. Values are a real ArduPilot's."""

from __future__ import annotations

import math
from pathlib import Path

import numpy as np
import pytest

from sitl.autopilot.copter.modes import systemid
from sitl.run import runner
from sitl.simulation import Core
from tests.flights.aviator import ALT_HOLD, GUIDED, LOITER, STABILIZE, Aviator
from tests.logs.dataflash.conftest import read_log

SYSTEMID = 25
SHORT = {"SID_F_START_HZ": 0.5, "SID_F_STOP_HZ": 5.0, "SID_T_FADE_IN": 2.0, "SID_T_REC": 14.0, "SID_T_FADE_OUT": 2.0}
TOTAL = 1.0 + 2.0 + 4.0 + 14.0 + 2.0
"""From the mode's begin to the end [s]."""


def flying(core: Core, axis: int, magnitude: float, mode: int = STABILIZE, **params: float) -> Aviator:
    """In a mode at 20 m, with what SYSTEMID shall do."""
    p = Aviator(core, "ardupilot_quad", RC_OVERRIDE_TIME=-1, SID_AXIS=axis, SID_MAGNITUDE=magnitude, **SHORT, **params)
    p.hover(20.0)
    p.sticks(0.5)
    assert p.set_mode(ALT_HOLD if mode == STABILIZE else mode)
    p.sticks(2.0)
    assert p.set_mode(mode)
    return p


def answer(p: Aviator, seconds: float) -> np.ndarray:
    """True body rates [deg/s] and acceleration [m/s^2], at 100 Hz."""
    rows = []
    for _ in range(round(seconds * 100)):
        p.fly(0.01)
        rows.append((*np.degrees(np.array(p.ap.estimate.rates)), p.simulation.v.sensors.acc.z))
    return np.array(rows)


def size(rows: np.ndarray) -> np.ndarray:
    """Greatest distance from the mean."""
    return np.abs(rows - rows.mean(axis=0)).max(axis=0)


@pytest.mark.parametrize(
    ("axis", "magnitude", "column", "peak"),
    [(1, 10.0, 0, 29.1), (2, 10.0, 1, 29.1), (4, 10.0, 0, 26.3), (7, 20.0, 0, 11.9), (10, 0.05, 0, 12.0),
     (3, 20.0, 2, 24.8), (13, 0.05, 3, 1.37)],
)  # fmt: skip
def test_an_axis_answers_its_chirp_and_the_others_stay_still(
    core: Core, axis: int, magnitude: float, column: int, peak: float
) -> None:
    p = flying(core, axis, magnitude)
    assert p.set_mode(SYSTEMID)
    assert p.said(f"SystemID Starting: axis={axis}")
    p.fly(2.9)
    found = size(answer(p, 2.0))
    assert found[column] == pytest.approx(peak, rel=0.15), "at 0.5 Hz, once it is full"
    quiet = np.array([1.5, 1.5, 2.5, 0.4])
    others = np.arange(4) != column
    assert (found[others] < quiet[others]).all(), found


@pytest.mark.parametrize(
    ("axis", "column", "peak", "yaw"), [(14, 0, 42.3, 3.5), (17, 1, 43.2, 3.5), (18, 0, 69.1, 2.5)]
)
def test_the_axes_of_the_position_lean_it(core: Core, axis: int, column: int, peak: float, yaw: float) -> None:
    """``yaw``: the heading is learnt from what leans it, too; 3.0, 2.4 and 0.5 deg/s."""
    p = flying(core, axis, 1.0, LOITER)
    assert p.set_mode(SYSTEMID)
    p.fly(2.9)
    found = size(answer(p, 2.0))
    assert found[column] == pytest.approx(peak, rel=0.25)
    assert found[1 - column] < 2.5 and found[2] < yaw
    p.fly(TOTAL)
    assert p.said("SystemID Finished")
    assert abs(p.height - 20.0) < 1.0


def test_it_is_logged_and_ends(core: Core, tmp_path: Path) -> None:
    p = flying(core, 1, 10.0)
    runner.open_dataflash(p.simulation, tmp_path / "a.bin")
    begin = p.now
    assert p.set_mode(SYSTEMID)
    assert p.fly(TOTAL + 1.0, lambda: p.said("SystemID Finished"))
    assert p.now - begin == pytest.approx(TOTAL, abs=0.1)
    assert p.mode == SYSTEMID, "it flies on as STABILIZE does"
    p.fly(2.0)
    assert abs(p.euler[0]) < 1.0
    p.simulation.close()
    log = read_log(tmp_path / "a.bin")
    (settings,) = log["SIDS"]
    assert (settings.Ax, settings.Mag, settings.FSt, settings.FSp, settings.TFin) == (1, 10.0, 0.5, 5.0, 2.0)
    assert (settings.TC, settings.TR, settings.TFout) == (4.0, 14.0, 2.0)
    samples = log["SIDD"]
    assert np.diff([m.TimeUS for m in samples]) == pytest.approx(10_000)
    time, chirp, hertz = (np.array([getattr(m, name) for m in samples]) for name in ("Time", "Targ", "F"))
    assert np.abs(chirp).max() == pytest.approx(10.0, rel=0.01)
    assert hertz.min() == pytest.approx(0.5) and hertz.max() == pytest.approx(5.0)
    assert hertz == pytest.approx([systemid.frequency(CHIRP, t - 1.0) / (2.0 * math.pi) for t in time], abs=1e-3)
    rates = np.array([(m.Gx, m.Gy, m.Gz) for m in samples])
    assert np.abs(rates[:, 0]).max() > 40.0 and np.abs(rates[:, 1:]).max() < 3.0


def test_refusals(core: Core) -> None:
    p = flying(core, 1, 10.0, GUIDED)
    assert not p.set_mode(SYSTEMID) and p.said("Axis requires manual throttle")
    assert p.said("Mode change to SYSTEMID failed: init failed")
    p.set_parameter("SID_AXIS", 14)
    assert not p.set_mode(SYSTEMID) and p.said("Axis requires switch from Loiter")
    p.set_parameter("SID_AXIS", 0)
    assert not p.set_mode(SYSTEMID) and p.said("No axis selected, SID_AXIS = 0")
    on_ground = Aviator(core, "ardupilot_quad", SID_AXIS=1).ready()
    assert not on_ground.set_mode(SYSTEMID) and on_ground.said("Aircraft must be flying")


def test_a_lean_beyond_the_limit_ends_it(core: Core) -> None:
    p = flying(core, 1, 60.0)
    assert p.set_mode(SYSTEMID)
    assert p.fly(15.0, lambda: p.said("SystemID Stopped: lean="))
    p.fly(3.0)
    assert abs(p.euler[0]) < 2.0


CHIRP = systemid.Chirp(10.0, math.pi, 10.0 * math.pi, 4.0, 2.0, 14.0, 2.0)


def test_the_chirp_rises_exponentially_without_a_step() -> None:
    times = np.arange(-0.5, 15.0, 0.001)
    values = np.array([systemid.value(CHIRP, t) for t in times])
    assert np.abs(np.diff(values)).max() < 10.0 * 10.0 * math.pi * 0.001 * 1.01
    assert np.abs(values).max() == pytest.approx(10.0, rel=1e-3)
    assert (values[times < 0.0] == 0.0).all() and (values[times > 14.0] == 0.0).all()
    assert systemid.frequency(CHIRP, 4.0) == math.pi and systemid.frequency(CHIRP, 14.0) == pytest.approx(10 * math.pi)
    assert systemid.frequency(CHIRP, 9.0) == pytest.approx(math.pi * math.sqrt(10.0))
    constant = systemid.Chirp(1.0, math.pi, math.pi, 4.0, 0.0, 14.0, 0.0)
    assert systemid.value(constant, 4.5) == pytest.approx(1.0)


@pytest.mark.parametrize("number", [22, 28])
def test_modes_that_the_simulator_cannot_fly_are_known_and_refused(core: Core, number: int) -> None:
    p = Aviator(core, "ardupilot_quad", SERVO_DSHOT_ESC=1).ready()
    assert not p.set_mode(number)
    assert p.said(f"Mode change to {'FLOWHOLD' if number == 22 else 'TURTLE'} failed: init failed")
