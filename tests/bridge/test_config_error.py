# SPDX-License-Identifier: BSD-3-Clause
"""A vehicle that finds no barometer says so every five seconds, does not start, and goes on after it is mended."""

from __future__ import annotations

from sitl.bridge.links.inprocess import InProcessLink
from sitl.client.endpoint import Endpoint
from sitl.simulation import Core, Simulation

REBOOT, RUN_CHECKS = 246, 401


def texts(simulation: Simulation, client: Endpoint, seconds: float) -> list[str]:
    simulation.advance(seconds)
    return [m.fields.text.decode() for m in client.receive() if m.name == "STATUSTEXT"]


def test_without_a_barometer_nothing_starts_until_it_is_mended(core: Core) -> None:
    simulation = Simulation("ardupilot_quad", core=core, params={"SIM_BARO_COUNT": -1})
    link = InProcessLink()
    simulation.bridge.add_link(link)
    client = Endpoint(link)
    said = texts(simulation, client, 31.0)
    assert said.count("Config Error: fix problem then reboot") == 6
    assert said.count("Config Error: Baro: unable to initialise driver") == 6
    client.command(RUN_CHECKS)
    said = texts(simulation, client, 0.1)
    assert "PreArm: Baro: not healthy" in said
    ap = simulation.v.autopilot
    assert not ap.estimate.attitude_ok and not ap.estimate.origin_set
    name = b"SIM_BARO_COUNT"
    client.send("PARAM_SET", target_system=1, target_component=1, param_id=name, param_value=2, param_type=9)
    assert any("Config Error" in text for text in texts(simulation, client, 5.5)), "not before the reboot"
    client.command(REBOOT, 1)
    said = texts(simulation, client, 60.0)
    assert not any("Config Error" in text for text in said) and simulation.v.autopilot.estimate.position_ok
