# SPDX-License-Identifier: BSD-3-Clause
"""Whole flights and drives on JSBSim, under the firmware and parameters that fly native physics."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from benchmarks import engines
from sitl.simulation import Simulation

pytest.importorskip("jsbsim")
pytestmark = pytest.mark.slow


def aligned(ours: engines.Flown, native: engines.Flown) -> engines.Flown:
    """``ours`` with its clock set so that both reach the first mission item at once: the end of a take-off is seen at a
    threshold, one row (40 ms) sooner or later, which is 0.4 m on the way at 10 m/s."""
    if not ours.reached:
        return ours
    early = native.reached[0][0] - ours.reached[0][0]
    assert abs(early) < 0.041
    rows = ours.rows.copy()
    rows[:, 0] += early
    return replace(ours, rows=rows)


@pytest.mark.parametrize("frame", ["erle_copter", "ardupilot_quad"])
@pytest.mark.parametrize("script", [engines.copter_guided, engines.copter_mission])
def test_copters_fly_as_on_native_physics(frame: str, script: engines.Script) -> None:
    """Boot, arm, take off, fly, land, disarm."""
    ours, native = (engines.fly(frame, script, physics) for physics in ("jsbsim", "native"))
    d = engines.difference(aligned(ours, native), native)
    assert [item for _, item in ours.reached] == [item for _, item in native.reached]
    assert (d.path_rms, d.path_max) < (0.15, 0.5)
    assert d.lean_rms < (0.35 if frame == "ardupilot_quad" else 0.3), "JSBSim's have gyroscopic torque"
    assert abs(d.output_mean) < 0.005
    assert abs(d.energy) < 1.0
    assert abs(d.duration) < 0.5
    assert -0.1 < ours.rows[-1, 3] < 0.1


@pytest.mark.parametrize("frame", ["erle_rover", "ardupilot_rover", "skid_rover"])
def test_rovers_drive_as_on_native_physics(frame: str) -> None:
    ours, native = (engines.fly(frame, engines.rover_mission, physics) for physics in ("jsbsim", "native"))
    d = engines.difference(ours, native)
    assert [item for _, item in ours.reached] == [1, 2, 3, 4]
    assert d.path_rms < (1.0 if frame == "skid_rover" else 0.3)
    assert d.items < 1.5


def test_turbulence_is_flown_through() -> None:
    """0.5 m/s of it and 4 m/s of wind: the mission is flown all the same."""
    simulation = Simulation("erle_copter", physics="jsbsim", params={"SIM_WIND_SPD": 4.0, "SIM_WIND_TURB": 0.5})
    pilot = engines.copter_mission(simulation)
    assert pilot.reached == [1, 2, 3, 4, 5]
    rows = np.array(pilot.truth)
    assert 0.05 < np.degrees(rows[:, 7:9]).std() < 10.0
    assert not simulation.v.autopilot.arming.armed


def test_a_reboot_in_mid_air_stands_on_the_ground_again() -> None:
    simulation = Simulation("erle_copter", physics="jsbsim", seed=5)
    simulation.advance_to(20_000_000)
    expected = bytes(simulation.v.physics._bytes)
    simulation.v.actuators.controls[:4] = 0.7
    for _ in range(400):
        simulation.plant.engine.tick()  # type: ignore[attr-defined]
    assert simulation.v.physics.body.pos[2] < -0.5
    simulation.request_reboot()
    start = simulation.time_us
    simulation.advance_to(start + 20_000_000)
    assert bytes(simulation.v.physics._bytes) == expected
