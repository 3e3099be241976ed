# SPDX-License-Identifier: BSD-3-Clause
"""Whatever well-formed messages carry and whenever they come, the vehicle stays defined and can be stopped."""

from __future__ import annotations

import math
from collections.abc import Iterable
from typing import Any

import numpy as np
import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from benchmarks.recorded.pilot import Pilot, items
from sitl.autopilot.copter.modes.mode_list import is_known as is_copter_mode
from sitl.autopilot.rover.firmware import FIRMWARE as ROVER
from sitl.autopilot.rover.modes.auto import AUTO
from sitl.autopilot.rover.modes.guided import GUIDED
from sitl.autopilot.rover.modes.hold import HOLD
from sitl.autopilot.rover.modes.mode_list import is_known as is_rover_mode
from sitl.autopilot.rover.modes.rtl import RTL
from sitl.autopilot.rover.modes.smart_rtl import SMART_RTL
from sitl.bridge import dialect
from sitl.bridge.copter.vehicle_commands import COMMANDS as COPTER_COMMANDS
from sitl.bridge.rover.vehicle_commands import COMMANDS as ROVER_COMMANDS
from sitl.client.endpoint import Endpoint
from sitl.core.records import as_dict
from sitl.simulation import Simulation, Snapshot

DO_SET_MODE, LAND, ARM_DISARM = 176, 21, 400
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
axis = st.integers(-1000, 1000)
places = st.fixed_dictionaries({"x": whole, "y": whole, "z": numbers})
parameters = st.fixed_dictionaries({f"param{k}": numbers for k in range(1, 5)})
vectors = st.fixed_dictionaries(dict.fromkeys(("vx", "vy", "vz", "afx", "afy", "afz", "yaw", "yaw_rate"), numbers))
targets = st.fixed_dictionaries({"coordinate_frame": byte, "type_mask": word})


def merged(*parts: dict[str, Any]) -> dict[str, Any]:
    return {k: v for part in parts for k, v in part.items()}


def message(name: str, *parts: st.SearchStrategy[dict[str, Any]], **fields: st.SearchStrategy[Any]) -> Any:
    """Strategy of (message name, its fields)."""
    return st.builds(lambda *found: (name, merged(*found)), *parts, st.fixed_dictionaries(fields))


def messages(commands: Iterable[int], items: Iterable[int]) -> Any:
    """Strategy of messages with one of these commands, or mission items."""
    number, item = st.sampled_from(sorted(commands)), st.sampled_from((*items, 0, 65535))
    return st.one_of(
        message("COMMAND_LONG", parameters, command=number, param5=numbers, param6=numbers, param7=numbers),
        message("COMMAND_INT", parameters, places, command=number, frame=byte),
        message("SET_POSITION_TARGET_LOCAL_NED", targets, vectors, x=numbers, y=numbers, z=numbers),
        message("SET_POSITION_TARGET_GLOBAL_INT", targets, vectors, lat_int=whole, lon_int=whole, alt=numbers),
        message(
            "SET_ATTITUDE_TARGET", type_mask=byte, q=st.tuples(*[numbers] * 4), thrust=numbers,
            body_roll_rate=numbers, body_pitch_rate=numbers, body_yaw_rate=numbers,
        ),
        message("RC_CHANNELS_OVERRIDE", **{f"chan{k}_raw": word for k in range(1, 9)}),
        message("MANUAL_CONTROL", target=st.just(1), x=axis, y=axis, z=axis, r=axis),
        message("MISSION_COUNT", count=st.integers(0, 3), mission_type=st.sampled_from((0, 0, 1, 2, 255))),
        message("MISSION_ITEM_INT", parameters, places, command=item, frame=byte, seq=st.integers(0, 3), current=byte),
        message("MISSION_SET_CURRENT", seq=st.integers(0, 6)),
        message("MISSION_CLEAR_ALL", mission_type=byte),
        message("SET_MODE", base_mode=byte, custom_mode=st.integers(0, 30)),
        message("SET_HOME_POSITION", latitude=whole, longitude=whole, altitude=whole),
        message("SET_GPS_GLOBAL_ORIGIN", latitude=whole, longitude=whole, altitude=whole),
    )  # fmt: skip


def finite(value: Any) -> bool:
    if isinstance(value, dict | list):
        return all(map(finite, value.values() if isinstance(value, dict) else value))
    return bool(np.all(np.isfinite(np.asarray(value, float))))


class Phases:
    """One vehicle, and snapshots of it at the phases of a flight or drive."""

    frame: str
    names: tuple[str, ...]
    messages: Any
    min_control: float

    def __init__(self) -> None:
        self.simulation = Simulation(self.frame)
        self.pilot = Pilot(self.simulation)
        self.at: dict[str, Snapshot] = {}
        self.pilot.fly(3.0)
        self._keep("booting")
        self.travel(self.pilot)
        assert tuple(self.at) == self.names

    def _keep(self, name: str) -> None:
        self.pilot.connection.endpoint.receive()
        self.at[name] = self.simulation.snapshot()

    def go(self, name: str) -> tuple[Simulation, Endpoint]:
        """The vehicle at this phase."""
        self.pilot.connection.endpoint.receive()
        self.simulation.restore(self.at[name])
        return self.simulation, self.pilot.connection.endpoint

    def travel(self, pilot: Pilot) -> None:
        """Through all phases but the first."""
        raise NotImplementedError

    def parts(self, autopilot: Any) -> tuple[Any, ...]:
        """What must stay finite."""
        raise NotImplementedError

    def is_known(self, mode: int) -> bool:
        raise NotImplementedError

    def stop(self, simulation: Simulation, client: Endpoint) -> None:
        """It can be brought to rest and disarmed."""
        raise NotImplementedError

    def check_defined(self) -> None:
        """Mode known, all of estimate, controllers and body finite, actuators within their range."""
        v = self.simulation.v
        assert self.is_known(int(v.autopilot.modes.number))
        for part in self.parts(v.autopilot):
            assert finite(as_dict(part)), as_dict(part)
        assert finite(as_dict(v.physics.body))
        controls = [float(c) for c in v.actuators.controls[:4]]
        assert all(self.min_control <= c <= 1.0 for c in controls), controls
        assert all(0 <= int(p) <= 2200 for p in v.actuators.pwm[:4])


class CopterPhases(Phases):
    frame = "erle_copter"
    names = ("booting", "ready", "armed", "climbing", "hovering", "on a mission", "landing")
    messages = messages(COPTER_COMMANDS, (16, 17, 18, 19, 20, 21, 22, 93, 112, 114, 115, 177, 178, 179, 195, 197))
    min_control = 0.0
    mission = (
        (0, 16, -353632621, 1491652371, 584.0), (3, 22, 0, 0, 8.0), (3, 16, -353630000, 1491652371, 8.0),
        (3, 16, -353630000, 1491656000, 8.0), (3, 20, 0, 0, 0.0),
    )  # fmt: skip

    def travel(self, pilot: Pilot) -> None:
        pilot.boot()
        self._keep("ready")
        pilot.transfer(items(self.mission))
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

    def parts(self, autopilot: Any) -> tuple[Any, ...]:
        control = autopilot.control
        return autopilot.estimate, autopilot.home, control.attitude, control.pos_ne, control.pos_d, autopilot.modes.nav

    def is_known(self, mode: int) -> bool:
        return is_copter_mode(mode)

    def stop(self, simulation: Simulation, client: Endpoint) -> None:
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
        self.check_defined()


class RoverPhases(Phases):
    frame = "erle_rover"
    names = (
        "booting", "ready", "armed", "to a place", "at speed", "on a mission", "on the way home", "back the same way",
    )  # fmt: skip
    messages = messages(ROVER_COMMANDS, ROVER.commands.taken)
    min_control = -1.0
    mission = (
        (0, 16, -353632621, 1491652371, 584.0), (3, 16, -353630824, 1491652371, 0.0),
        (3, 16, -353630824, 1491654574, 0.0), (3, 20, 0, 0, 0.0),
    )  # fmt: skip

    def travel(self, pilot: Pilot) -> None:
        pilot.fly(45.0)
        self._keep("ready")
        pilot.transfer(items(self.mission))
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
        assert self.simulation.v.autopilot.modes.number == AUTO
        for mode, name in ((RTL, "on the way home"), (SMART_RTL, "back the same way")):
            pilot.send_command("DO_SET_MODE", 1, mode)
            pilot.fly(2.0)
            assert self.simulation.v.autopilot.modes.number == mode, pilot.texts
            self._keep(name)

    def parts(self, autopilot: Any) -> tuple[Any, ...]:
        return autopilot.estimate, autopilot.home, autopilot.control, autopilot.modes

    def is_known(self, mode: int) -> bool:
        return is_rover_mode(mode)

    def stop(self, simulation: Simulation, client: Endpoint) -> None:
        """HOLD is accepted and stops it; it can be disarmed."""
        simulation.advance(4.0)  # overrides and set-points of before expire
        system = int(simulation.v.autopilot.params.MAV_SYSID)
        for command, wait in (((DO_SET_MODE, 1, HOLD), 20.0), ((ARM_DISARM, 0), 0.1)):
            client.receive()
            client.command(*command, target=system)
            simulation.advance(wait)
            acks = [m.fields for m in client.receive() if m.name == "COMMAND_ACK" and m.fields.command == command[0]]
            assert [a.result for a in acks] == [0]
            self.check_defined()
        speed = float(np.linalg.norm(simulation.v.physics.body.vel))
        assert speed < 0.2 and not simulation.v.autopilot.arming.armed, speed


@pytest.fixture(scope="module", params=[CopterPhases, RoverPhases], ids=["copter", "rover"])
def phases(request: pytest.FixtureRequest) -> Phases:
    return request.param()  # type: ignore[no-any-return]


@few
@given(data=st.data())
def test_any_messages_at_any_phase(phases: Phases, data: st.DataObject) -> None:
    simulation, client = phases.go(data.draw(st.sampled_from(phases.names)))
    sent = st.lists(st.tuples(phases.messages, st.sampled_from((0.0, 0.01, 0.3, 1.0))), max_size=8)
    for (name, fields), wait in data.draw(sent):
        known = dialect.message(name).fields
        client.send(name, **{k: v for k, v in TARGET.items() if k in known}, **fields)
        simulation.advance(wait)
        phases.check_defined()
    phases.stop(simulation, client)


@few
@given(data=st.data())
def test_any_parameters_at_any_phase(phases: Phases, data: st.DataObject) -> None:
    """The flight may be poor, the state stays defined."""
    simulation, client = phases.go(data.draw(st.sampled_from(phases.names)))
    names = st.sampled_from([p.name for p in simulation.kind.firmware.table.with_effect])
    changes = st.lists(st.tuples(names, st.one_of(numbers, st.floats(0.0, 1000.0, width=32))), max_size=6)
    for name, value in data.draw(changes):
        system = int(simulation.v.autopilot.params.MAV_SYSID)
        client.send("PARAM_SET", target_system=system, param_id=name.encode(), param_value=value, param_type=9)
        simulation.advance(0.2)
        phases.check_defined()
        assert finite(as_dict(simulation.v.autopilot.params))
    simulation.advance(2.0)
    phases.check_defined()
