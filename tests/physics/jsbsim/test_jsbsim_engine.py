# SPDX-License-Identifier: BSD-3-Clause
"""JSBSim as an engine: what it refuses, repeats and snapshots."""

from __future__ import annotations

import re
import sys
from typing import Any

import numpy as np
import pytest

from sitl.errors import MissingExtra, OptionError
from sitl.physics.engine import EngineError
from sitl.physics.jsbsim.formula import component, difference, function, if_less, limited, product, total
from sitl.simulation import Simulation
from tests.physics.jsbsim.jsbsim_bench import Bench

FRAMES = pytest.mark.parametrize(
    ("frame", "controls"),
    [
        ("erle_copter", (0.62, 0.6, 0.61, 0.61)),
        ("ardupilot_quad", (0.62, 0.6, 0.61, 0.61)),
        ("erle_rover", (0.3, 0.0, 0.6)),
        ("ardupilot_rover", (0.3, 0.0, 0.3)),
        ("skid_rover", (0.5, 0.0, 0.3)),
    ],
)


def test_solids_are_refused() -> None:
    with pytest.raises(EngineError, match=re.escape("'native' or 'pybullet'")):
        Simulation("erle_copter", physics="jsbsim", world="maze")


def test_without_jsbsim_the_extra_is_named(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setitem(sys.modules, "jsbsim", None)
    with pytest.raises(MissingExtra, match=re.escape("gym-sitl[jsbsim]")):
        Simulation("erle_copter", physics="jsbsim")


@FRAMES
def test_equal_runs_are_equal(frame: str, controls: tuple[float, ...]) -> None:
    """In another executive, and again from power-on in the same one."""
    first, second = Bench(frame, seed=3), Bench(frame, seed=3)
    first.run(2.0, *controls)
    for _ in range(2):
        second.run(2.0, *controls)
        assert second.digest() == first.digest()
        second.simulation.plant.power_on()


@FRAMES
def test_snapshots_go_on_bit_for_bit(frame: str, controls: tuple[float, ...]) -> None:
    """After a snapshot, after restoring it, and in another engine."""
    b, other = Bench(frame), Bench(frame)
    b.run(2.0, *controls)
    state, record = b.engine.snapshot(), b.simulation.fleet.tobytes()
    b.run(2.0)
    expected = b.digest()
    other.run(0.5, *controls[::-1])
    for one in (b, other):
        one.simulation.fleet.view("u1")[:] = np.frombuffer(record, "u1")
        one.engine.restore(state)
        one.run(2.0)
        assert one.digest() == expected


@FRAMES
def test_a_snapshot_disturbs_little(frame: str, controls: tuple[float, ...]) -> None:
    left, alone = Bench(frame), Bench(frame)
    for b in (left, alone):
        b.run(2.0, *controls)
        if b is left:
            b.engine.snapshot()
        b.run(0.5)
    assert left.body.pos == pytest.approx(alone.body.pos, abs=1e-6)
    assert left.body.vel == pytest.approx(alone.body.vel, abs=1e-6)


def test_says_nothing_and_leaves_nothing(
    capfd: pytest.CaptureFixture[str], tmp_path: Any, monkeypatch: pytest.MonkeyPatch
) -> None:
    """No output, no files, when the copter takes off and touches."""
    monkeypatch.chdir(tmp_path)
    monkeypatch.setenv("TMPDIR", str(tmp_path))
    monkeypatch.setattr("tempfile.tempdir", None)
    b = Bench("erle_copter")
    b.run(1.0, *(0.65,) * 4)
    b.run(3.0, *(0.0,) * 4)
    assert b.p.ground.hit_count > 0
    assert capfd.readouterr() == ("", "")
    assert list(tmp_path.iterdir()) == []


def test_properties_count() -> None:
    b = Bench("erle_copter")
    heavy = Bench(b.simulation.airframe.changed(mass=3.0))
    for one in (b, heavy):
        one.run(1.0, *(0.65,) * 4)
    assert b.body.pos[2] < -0.3
    assert abs(heavy.body.pos[2]) < 0.01


def test_a_snapshot_brings_its_properties() -> None:
    heavy, light = Bench("erle_copter"), Bench("erle_copter")
    heavy.p.airframe.mass = 3.0
    heavy.engine.place()
    state, record = heavy.engine.snapshot(), heavy.simulation.fleet.tobytes()
    light.simulation.fleet.view("u1")[:] = np.frombuffer(record, "u1")
    light.engine.restore(state)
    for one in (heavy, light):
        one.run(1.0, *(0.65,) * 4)
    assert light.digest() == heavy.digest()
    assert abs(light.body.pos[2]) < 0.01, "too heavy to fly"


def test_turbulence_repeats_itself_after_a_snapshot() -> None:
    b = Bench("erle_copter")
    b.run(0.5, *(0.65,) * 4)
    state, record, ends = b.engine.snapshot(), b.simulation.fleet.tobytes(), []
    for _ in range(2):
        b.p.wind.turbulence = 2.0
        b.run(1.0)
        ends.append(b.digest())
        b.simulation.fleet.view("u1")[:] = np.frombuffer(record, "u1")
        b.engine.restore(state)
    assert ends[0] == ends[1]


def test_zero_is_nothing() -> None:
    assert product("a/b", 0.0) == ""
    assert total("", product("a", 0.0)) == ""
    assert total("a", product("b", 0.0)) == "<p>a</p>"
    assert difference("a", "") == "<p>a</p>"


def test_numbers_of_a_product_become_one() -> None:
    assert product(2.0, "a", 0.25, "b") == "<product><p>a</p><p>b</p><v>0.5</v></product>"
    assert product(2.0, "a", 0.5) == "<p>a</p>"
    assert product(2.0, 3.0) == "<v>6.0</v>"


def test_nothing_where_a_number_is_needed_is_zero() -> None:
    assert difference("", "a") == "<difference><v>0</v><p>a</p></difference>"
    assert function("f", "") == '<function name="f"><v>0</v></function>'
    assert component("g", 1.0) == '<fcs_function name="g"><function><v>1.0</v></function></fcs_function>'


def test_bounds_and_cases() -> None:
    assert limited("a", 2.0) == "<max><min><p>a</p><v>2.0</v></min><v>-2.0</v></max>"
    assert if_less("a", 0.0, 1.0, "b") == ("<ifthen><lt><p>a</p><v>0</v></lt><v>1.0</v><p>b</p></ifthen>")


@pytest.mark.parametrize("fault", ["shove", "twist@5", "motor/slow"])
def test_faults_that_do_nothing_to_it_are_refused(fault: str) -> None:
    with pytest.raises(OptionError, match=r"does nothing to physics jsbsim; there are gps, gyro, .* motor, .* wind"):
        Simulation("erle_copter", physics="jsbsim", faults=[fault])
    simulation = Simulation("erle_rover", physics="jsbsim", faults=["motor/slow", "servo/slow"])
    assert simulation.v.physics.derived.motor_lag == 0.5
    simulation.close()
