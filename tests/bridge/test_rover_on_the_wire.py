# SPDX-License-Identifier: BSD-3-Clause
"""Whatever well-formed messages carry and whenever they come, the rover stays in a defined state and can be stopped."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from sitl.autopilot.rover.firmware import FIRMWARE
from sitl.autopilot.rover.modes.auto import AUTO
from sitl.autopilot.rover.modes.guided import GUIDED
from sitl.autopilot.rover.modes.hold import HOLD
from sitl.autopilot.rover.modes.rtl import RTL
from sitl.autopilot.rover.modes.smart_rtl import SMART_RTL
from sitl.autopilot.rover.modes.table import is_known
from sitl.bridge import dialect
from sitl.bridge.rover.commands import COMMANDS
from sitl.client.endpoint import Endpoint
from sitl.core.records import as_dict
from sitl.missions.pilot import Pilot, items
from sitl.simulation import Simulation, Snapshot
from tests.bridge.wire_messages import messages, numbers

DO_SET_MODE = 176

MISSION = [
    (0, 16, -353632621, 1491652371, 584.0), (3, 16, -353630824, 1491652371, 0.0), (3, 16, -353630824, 1491654574, 0.0),
    (3, 20, 0, 0, 0.0),
]  # fmt: skip
TARGET = {"target_system": 1, "target_component": 1}
MESSAGES = messages(COMMANDS, FIRMWARE.commands.taken)
few = settings(max_examples=40, deadline=None, suppress_health_check=[HealthCheck.function_scoped_fixture])
PHASES = ("booting", "ready", "armed", "to a place", "at speed", "on a mission", "on the way home", "back the same way")


class Phases:
    """One rover, and snapshots of it at the phases of a drive."""

    def __init__(self) -> None:
        self.simulation = Simulation("erle_rover")
        self.pilot = pilot = Pilot(self.simulation)
        self.at: dict[str, Snapshot] = {}
        pilot.fly(3.0)
        self._keep("booting")
        pilot.fly(45.0)
        self._keep("ready")
        pilot.transfer(items(MISSION))
        pilot.send_command("DO_SET_MODE", 1, GUIDED)
        pilot.send_command("COMPONENT_ARM_DISARM", 1)
        pilot.fly(1.0)
        assert self.simulation.v.autopilot.arming.armed, pilot.texts
        self._keep("armed")
        place = {"coordinate_frame": 1, "type_mask": 0xDF8, "x": 8.0, "y": 5.0}
        pilot.send("SET_POSITION_TARGET_LOCAL_NED", **TARGET, **place)
        pilot.fly(3.0)
        self._keep("to a place")
        speed = {"coordinate_frame": 8, "type_mask": 0xDC7, "vx": 1.0}
        pilot.send("SET_POSITION_TARGET_LOCAL_NED", **TARGET, **speed)
        pilot.fly(2.0)
        self._keep("at speed")
        pilot.send_command("MISSION_START")
        pilot.fly(4.0)
        self._keep("on a mission")
        for mode, name in ((RTL, "on the way home"), (SMART_RTL, "back the same way")):
            pilot.send_command("DO_SET_MODE", 1, mode)
            pilot.fly(2.0)
            assert self.simulation.v.autopilot.modes.number == mode, pilot.texts
            self._keep(name)

    def _keep(self, name: str) -> None:
        self.pilot.connection.endpoint.receive()
        self.at[name] = self.simulation.snapshot()

    def go(self, name: str) -> tuple[Simulation, Endpoint]:
        """The vehicle at this phase."""
        self.pilot.connection.endpoint.receive()
        self.simulation.restore(self.at[name])
        return self.simulation, self.pilot.connection.endpoint


@pytest.fixture(scope="module")
def phases() -> Phases:
    return Phases()


def finite(value: Any) -> bool:
    if isinstance(value, dict | list):
        return all(map(finite, value.values() if isinstance(value, dict) else value))
    return bool(np.all(np.isfinite(np.asarray(value, float))))


def check_defined(simulation: Simulation) -> None:
    """Mode known, all of estimate, controllers and body finite, actuators within their range."""
    ap = simulation.v.autopilot
    assert is_known(int(ap.modes.number))
    for part in (ap.estimate, ap.home, ap.control, ap.modes):
        assert finite(as_dict(part)), as_dict(part)
    assert finite(as_dict(simulation.v.physics.body))
    controls = [float(c) for c in simulation.v.actuators.controls[:4]]
    assert all(-1.0 <= c <= 1.0 for c in controls), controls
    assert all(0 <= int(p) <= 2200 for p in simulation.v.actuators.pwm[:4])


def hold(simulation: Simulation, client: Endpoint) -> None:
    """HOLD is accepted and stops it; it can be disarmed."""
    simulation.advance(4.0)  # overrides and set-points of before expire
    system = int(simulation.v.autopilot.params.MAV_SYSID)
    for command, wait in (((DO_SET_MODE, 1, HOLD), 20.0), ((400, 0), 0.1)):
        client.receive()
        client.command(*command, target=system)
        simulation.advance(wait)
        acks = [m.fields for m in client.receive() if m.name == "COMMAND_ACK" and m.fields.command == command[0]]
        assert [a.result for a in acks] == [0]
        check_defined(simulation)
    speed = float(np.linalg.norm(simulation.v.physics.body.vel))
    assert speed < 0.2 and not simulation.v.autopilot.arming.armed, speed


@few
@given(
    phase=st.sampled_from(PHASES),
    sent=st.lists(st.tuples(MESSAGES, st.sampled_from((0.0, 0.01, 0.3, 1.0))), max_size=8),
)
def test_any_messages_at_any_phase_of_a_rover(phases: Phases, phase: str, sent: list[Any]) -> None:
    simulation, client = phases.go(phase)
    for (name, fields), wait in sent:
        known = dialect.message(name).fields
        client.send(name, **{k: v for k, v in TARGET.items() if k in known}, **fields)
        simulation.advance(wait)
        check_defined(simulation)
    hold(simulation, client)


@few
@given(
    phase=st.sampled_from(PHASES),
    changes=st.lists(
        st.tuples(st.sampled_from(FIRMWARE.table.names()), st.one_of(numbers, st.floats(0.0, 1000.0, width=32))),
        max_size=6,
    ),
)
def test_any_parameters_at_any_phase_of_a_rover(phases: Phases, phase: str, changes: list[tuple[str, float]]) -> None:
    """The drive may be poor, the state stays defined."""
    simulation, client = phases.go(phase)
    for name, value in changes:
        system = int(simulation.v.autopilot.params.MAV_SYSID)
        client.send("PARAM_SET", target_system=system, param_id=name.encode(), param_value=value, param_type=9)
        simulation.advance(0.2)
        check_defined(simulation)
        assert finite(as_dict(simulation.v.autopilot.params))
    simulation.advance(2.0)
    check_defined(simulation)


def test_auto_was_one_of_the_phases(phases: Phases) -> None:
    simulation, _ = phases.go("on a mission")
    assert simulation.v.autopilot.modes.number == AUTO
