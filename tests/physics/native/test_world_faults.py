# SPDX-License-Identifier: BSD-3-Clause
"""SIM_ parameters that break things, and a reboot with them."""

from __future__ import annotations

from sitl.simulation import Core, Simulation


def test_a_receiver_that_is_switched_off_is_silent_and_comes_back(core: Core) -> None:
    simulation = Simulation(core=core)
    simulation.advance(15.0)
    sensors = simulation.v.sensors
    assert int(sensors.gps_fix) == 3
    simulation.v.autopilot.params.SIM_GPS1_ENABLE = 0
    simulation.parameter_changed("SIM_GPS1_ENABLE")
    simulation.advance(1.0)
    count = int(sensors.gps_count)
    simulation.advance(2.0)
    assert int(sensors.gps_count) == count
    assert int(sensors.gps_fix) == 0
    simulation.v.autopilot.params.SIM_GPS1_ENABLE = 1
    simulation.parameter_changed("SIM_GPS1_ENABLE")
    simulation.advance(1.0)
    assert int(sensors.gps_count) > count
    assert int(sensors.gps_fix) == 3


def test_faults_given_at_the_start_and_after_a_reboot(core: Core) -> None:
    faults = {"SIM_ENGINE_FAIL": 6, "SIM_ENGINE_MUL": 0.5, "SIM_RC_FAIL": 1, "SIM_GPS1_ENABLE": 0}
    simulation = Simulation(core=core, params=faults)
    for _ in range(2):
        simulation.advance(12.0)
        assert list(simulation.v.physics.rotors.efficiency[:4]) == [1.0, 0.5, 0.5, 1.0]
        assert int(simulation.v.sensors.gps_count) == 0
        assert int(simulation.v.autopilot.rc.receiver_ok) == 0
        simulation.request_reboot()
