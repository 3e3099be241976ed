# SPDX-License-Identifier: BSD-3-Clause
"""Whatever well-formed messages carry and whenever they come, the vehicle stays in a defined state and lands."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from missions.flights import MISSION_START, SET_MODE, TAKEOFF, Pilot, upload
from sitl.autopilot.modes.copter.numbers import is_known
from sitl.autopilot.params.table import TABLE as PARAMETERS
from sitl.bridge import dialect
from sitl.bridge.client import Client
from sitl.bridge.services.commands import TABLE as COMMANDS
from sitl.core.records import as_dict
from sitl.simulation import Core, Simulation, Snapshot

MISSION = [
    (0, 16, -353632621, 1491652371, 584.0), (3, 22, 0, 0, 8.0), (3, 16, -353630000, 1491652371, 8.0),
    (3, 16, -353630000, 1491656000, 8.0), (3, 20, 0, 0, 0.0),
]  # fmt: skip
LAND = 21
TARGET = {"target_system": 1, "target_component": 1}
few = settings(max_examples=40, deadline=None, suppress_health_check=[HealthCheck.function_scoped_fixture])

numbers = st.one_of(
    st.sampled_from((0.0, 1.0, -1.0, 2.0, math.nan, math.inf, -math.inf, 1e9, -1e9, 3.4e38, 1e-30, 21196.0, 2989.0)),
    st.floats(-50.0, 50.0, width=32),
)
whole = st.one_of(
    st.sampled_from((0, 1, -1, -(2**31), 2**31 - 1, 900_000_000, -1_800_000_000, -353632620, 1491652370)),
    st.integers(-(2**31), 2**31 - 1),
)
byte = st.one_of(st.sampled_from((0, 1, 2, 3, 5, 6, 8, 11, 255)), st.integers(0, 255))
word = st.one_of(st.sampled_from((0, 1500, 0x9C7, 0x9F8, 0xDC7, 0xDF8, 65535)), st.integers(0, 65535))
places = st.fixed_dictionaries({"x": whole, "y": whole, "z": numbers})
parameters = st.fixed_dictionaries({f"param{k}": numbers for k in range(1, 5)})
vectors = st.fixed_dictionaries(dict.fromkeys(("vx", "vy", "vz", "afx", "afy", "afz", "yaw", "yaw_rate"), numbers))
targets = st.fixed_dictionaries({"coordinate_frame": byte, "type_mask": word})
mission_commands = st.sampled_from((16, 17, 18, 19, 20, 21, 22, 93, 112, 114, 115, 177, 178, 179, 195, 197, 0, 65535))


def merged(*parts: dict[str, Any]) -> dict[str, Any]:
    return {k: v for part in parts for k, v in part.items()}


def message(name: str, *parts: st.SearchStrategy[dict[str, Any]], **fields: st.SearchStrategy[Any]) -> Any:
    """Strategy of (message name, its fields)."""
    return st.builds(lambda *found: (name, merged(*found)), *parts, st.fixed_dictionaries(fields))


command_number = st.sampled_from(sorted(COMMANDS))
MESSAGES = st.one_of(
    message("COMMAND_LONG", parameters, command=command_number, param5=numbers, param6=numbers, param7=numbers),
    message("COMMAND_INT", parameters, places, command=command_number, frame=byte),
    message("SET_POSITION_TARGET_LOCAL_NED", targets, vectors, x=numbers, y=numbers, z=numbers),
    message("SET_POSITION_TARGET_GLOBAL_INT", targets, vectors, lat_int=whole, lon_int=whole, alt=numbers),
    message(
        "SET_ATTITUDE_TARGET", type_mask=byte, q=st.tuples(*[numbers] * 4), thrust=numbers,
        body_roll_rate=numbers, body_pitch_rate=numbers, body_yaw_rate=numbers,
    ),
    message("RC_CHANNELS_OVERRIDE", **{f"chan{k}_raw": word for k in range(1, 9)}),
    message("MISSION_COUNT", count=st.integers(0, 3), mission_type=st.sampled_from((0, 0, 1, 2, 255))),
    message("MISSION_ITEM_INT", parameters, places, command=mission_commands, frame=byte, seq=st.integers(0, 3),
            current=byte),
    message("MISSION_SET_CURRENT", seq=st.integers(0, 6)),
    message("MISSION_CLEAR_ALL", mission_type=byte),
    message("SET_MODE", base_mode=byte, custom_mode=st.integers(0, 30)),
    message("SET_HOME_POSITION", latitude=whole, longitude=whole, altitude=whole),
    message("SET_GPS_GLOBAL_ORIGIN", latitude=whole, longitude=whole, altitude=whole),
)  # fmt: skip


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
        upload(pilot, MISSION)
        pilot.arm()
        self._keep("armed")
        pilot.client.command(TAKEOFF, 0, 0, 0, 0, 0, 0, 8.0)
        pilot.fly(2.5)
        self._keep("climbing")
        pilot.fly(12.0)
        self._keep("hovering")
        pilot.client.command(SET_MODE, 1, 3)
        pilot.client.command(MISSION_START)
        pilot.fly(3.0)
        self._keep("on a mission")
        pilot.client.command(LAND)
        pilot.fly(4.0)
        self._keep("landing")

    def _keep(self, name: str) -> None:
        self.pilot.client.receive()
        self.at[name] = self.simulation.snapshot()

    def go(self, name: str) -> tuple[Simulation, Client]:
        """The vehicle at this phase."""
        self.pilot.client.receive()
        self.simulation.restore(self.at[name])
        return self.simulation, self.pilot.client


@pytest.fixture(scope="module")
def phases(core: Core) -> Phases:
    return Phases(core)


PHASES = ("booting", "ready", "armed", "climbing", "hovering", "on a mission", "landing")


def finite(value: Any) -> bool:
    if isinstance(value, dict):
        return all(map(finite, value.values()))
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


def land(simulation: Simulation, client: Client) -> None:
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
