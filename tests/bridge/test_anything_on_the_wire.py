# SPDX-License-Identifier: BSD-3-Clause
"""Whatever well-formed messages carry and whenever they come, the vehicle stays in a defined state and lands."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from sitl.autopilot.copter.modes.table import is_known
from sitl.autopilot.copter.parameters import TABLE as PARAMETERS
from sitl.bridge import dialect
from sitl.bridge.copter.commands import COMMANDS
from sitl.client.endpoint import Endpoint
from sitl.core.records import as_dict
from sitl.missions.pilot import Pilot, items
from sitl.simulation import Core, Simulation, Snapshot
from tests.bridge.wire_messages import messages, numbers

MISSION = [
    (0, 16, -353632621, 1491652371, 584.0), (3, 22, 0, 0, 8.0), (3, 16, -353630000, 1491652371, 8.0),
    (3, 16, -353630000, 1491656000, 8.0), (3, 20, 0, 0, 0.0),
]  # fmt: skip
LAND = 21
TARGET = {"target_system": 1, "target_component": 1}
few = settings(max_examples=40, deadline=None, suppress_health_check=[HealthCheck.function_scoped_fixture])

MESSAGES = messages(COMMANDS, (16, 17, 18, 19, 20, 21, 22, 93, 112, 114, 115, 177, 178, 179, 195, 197))


class Phases:
    """One vehicle, and snapshots of it at the phases of a flight."""

    def __init__(self, core: Core) -> None:
        self.simulation = Simulation(core=core)
        self.pilot = pilot = Pilot(self.simulation)
        self.at: dict[str, Snapshot] = {}
        pilot.fly(3.0)
        self._keep("booting")
        pilot.boot()
        self._keep("ready")
        pilot.transfer(items(MISSION))
        pilot.arm()
        self._keep("armed")
        pilot.send_command("NAV_TAKEOFF", altitude=8.0)
        pilot.fly(2.5)
        self._keep("climbing")
        pilot.fly(12.0)
        self._keep("hovering")
        pilot.send_command("DO_SET_MODE", 1, 3)
        pilot.send_command("MISSION_START")
        pilot.fly(3.0)
        self._keep("on a mission")
        pilot.send_command("NAV_LAND")
        pilot.fly(4.0)
        self._keep("landing")

    def _keep(self, name: str) -> None:
        self.pilot.connection.endpoint.receive()
        self.at[name] = self.simulation.snapshot()

    def go(self, name: str) -> tuple[Simulation, Endpoint]:
        """The vehicle at this phase."""
        self.pilot.connection.endpoint.receive()
        self.simulation.restore(self.at[name])
        return self.simulation, self.pilot.connection.endpoint


@pytest.fixture(scope="module")
def phases(core: Core) -> Phases:
    return Phases(core)


PHASES = ("booting", "ready", "armed", "climbing", "hovering", "on a mission", "landing")


def finite(value: Any) -> bool:
    if isinstance(value, dict | list):
        return all(map(finite, value.values() if isinstance(value, dict) else value))
    return bool(np.all(np.isfinite(np.asarray(value, float))))


def check_defined(simulation: Simulation) -> None:
    """Mode known, all of estimate, controllers and body finite, actuators within their range."""
    ap = simulation.v.autopilot
    assert is_known(int(ap.modes.number))
    for part in (ap.estimate, ap.home, ap.control.attitude, ap.control.pos_ne, ap.control.pos_d, ap.modes.nav):
        assert finite(as_dict(part)), as_dict(part)
    assert finite(as_dict(simulation.v.physics.body))
    controls = [float(c) for c in simulation.v.actuators.controls[:4]]
    assert all(0.0 <= c <= 1.0 for c in controls), controls
    assert all(0 <= int(p) <= 2200 for p in simulation.v.actuators.pwm[:4])


def land(simulation: Simulation, client: Endpoint) -> None:
    """A land command is accepted and ends on the ground, disarmed."""
    simulation.advance(4.0)  # overrides and set-points of before expire
    client.receive()
    system = int(simulation.v.autopilot.params.MAV_SYSID)
    client.command(LAND, target=system)
    simulation.advance(0.1)
    results = [m.fields.result for m in client.receive() if m.name == "COMMAND_ACK" and m.fields.command == LAND]
    assert results == [0]
    for _ in range(90):
        if not simulation.v.autopilot.arming.armed:
            break
        simulation.advance(2.0)
    assert not simulation.v.autopilot.arming.armed, float(simulation.v.physics.body.pos[2])
    check_defined(simulation)


@few
@given(
    phase=st.sampled_from(PHASES),
    sent=st.lists(st.tuples(MESSAGES, st.sampled_from((0.0, 0.01, 0.3, 1.0))), max_size=8),
)
def test_any_messages_at_any_phase(phases: Phases, phase: str, sent: list[Any]) -> None:
    simulation, client = phases.go(phase)
    for (name, fields), wait in sent:
        known = dialect.message(name).fields
        client.send(name, **{k: v for k, v in TARGET.items() if k in known}, **fields)
        simulation.advance(wait)
        check_defined(simulation)
    land(simulation, client)


@few
@given(
    phase=st.sampled_from(PHASES),
    changes=st.lists(
        st.tuples(st.sampled_from([p.name for p in PARAMETERS]), st.one_of(numbers, st.floats(0.0, 1000.0, width=32))),
        max_size=6,
    ),
)
def test_any_parameters_at_any_phase(phases: Phases, phase: str, changes: list[tuple[str, float]]) -> None:
    """The flight may be poor, the state stays defined."""
    simulation, client = phases.go(phase)
    for name, value in changes:
        system = int(simulation.v.autopilot.params.MAV_SYSID)
        client.send("PARAM_SET", target_system=system, param_id=name.encode(), param_value=value, param_type=9)
        simulation.advance(0.2)
        check_defined(simulation)
        assert finite(as_dict(simulation.v.autopilot.params))
    simulation.advance(2.0)
    check_defined(simulation)
