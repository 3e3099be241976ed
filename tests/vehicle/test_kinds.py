# SPDX-License-Identifier: BSD-3-Clause
"""A third kind of vehicle (``boat``) is registered from outside: everything shared takes it as it takes the others."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace
from importlib.metadata import EntryPoint

import pytest

from sitl import vehicles
from sitl.bridge.firmware_profile import Profile
from sitl.bridge.wire.choose import message_of
from sitl.client import Endpoint
from sitl.errors import OptionError
from sitl.logs.kind import logs_of
from sitl.physics.engine import EngineError
from sitl.simulation import Simulation
from sitl.vehicle import kinds
from sitl.vehicle.kind import Kind, MissingPartError
from sitl.vehicle.kinds import BUILT_IN, KINDS, Kinds, UnknownKindError

from .boat.kind import BOAT
from .boat.physics import AIRFRAME

ARM = 400


@pytest.fixture
def boat() -> Iterator[Kind]:
    yield KINDS.register(BOAT)
    KINDS.unregister("boat")


@pytest.fixture
def simulation(boat: Kind) -> Iterator[Simulation]:
    simulation = Simulation(AIRFRAME, seed=3, estimator="truth")
    yield simulation
    simulation.close()


def _connect(simulation: Simulation) -> Endpoint:
    client = Endpoint()
    simulation.bridge.add_link(client.link)
    client.send("HEARTBEAT", type=6, autopilot=8)
    return client


def test_it_is_found_by_its_name(boat: Kind) -> None:
    assert KINDS["boat"] is BOAT
    assert tuple(KINDS) == (*BUILT_IN, "boat")


def test_an_unknown_kind_is_refused_and_those_there_are_named() -> None:
    assert "boat" not in KINDS
    with pytest.raises(UnknownKindError, match="vehicle 'coptr' is none of copter, rover; did you mean 'copter'"):
        KINDS["coptr"]
    with pytest.raises(UnknownKindError, match="vehicle 'boat' is none of copter, rover"):
        Simulation(AIRFRAME)


def test_a_kind_of_an_installed_package_is_found_by_its_entry_point(monkeypatch: pytest.MonkeyPatch) -> None:
    point = EntryPoint("boat", f"{__package__}.boat.kind:BOAT", kinds.GROUP)
    monkeypatch.setattr(kinds, "_installed", lambda: {"boat": point})
    every = Kinds()
    assert tuple(every) == (*BUILT_IN, "boat") and "boat" in every
    assert every["boat"] is BOAT and every.of_mav_type(2) is KINDS["copter"]


def test_an_entry_point_that_is_no_kind_is_refused(monkeypatch: pytest.MonkeyPatch) -> None:
    point = EntryPoint("ship", f"{__package__}.boat.kind:BOAT", kinds.GROUP)
    monkeypatch.setattr(kinds, "_installed", lambda: {"ship": point})
    with pytest.raises(UnknownKindError, match=r"entry point 'ship' of group sitl\.kinds: .* is no Kind of this name"):
        Kinds()["ship"]


def test_an_airframe_of_an_installed_package_is_found_by_its_entry_point(monkeypatch: pytest.MonkeyPatch) -> None:
    point = EntryPoint("dinghy", f"{__package__}.boat.physics:AIRFRAME", vehicles.GROUP)
    monkeypatch.setattr(vehicles, "_installed", lambda: {"dinghy": point})
    assert vehicles.load("dinghy") is AIRFRAME and vehicles.names("boat") == ("dinghy",)


def test_two_kinds_cannot_have_one_name(boat: Kind) -> None:
    assert KINDS.register(BOAT) is BOAT
    with pytest.raises(OptionError, match="there is a vehicle 'boat' already"):
        KINDS.register(replace(BOAT))


def test_it_says_hello_and_arms(simulation: Simulation) -> None:
    client = _connect(simulation)
    simulation.advance(1.5)
    heartbeats = [m.fields for m in client.receive() if m.name == "HEARTBEAT"]
    assert heartbeats and heartbeats[-1].type == BOAT.mav_type and not heartbeats[-1].base_mode & 128
    client.command(ARM, 1.0)
    simulation.advance(1.5)
    received = client.receive()
    assert [m.fields.result for m in received if m.name == "COMMAND_ACK"] == [0]
    assert next(m.fields for m in reversed(received) if m.name == "HEARTBEAT").base_mode & 128


def test_its_parameters_are_listed(simulation: Simulation) -> None:
    client = _connect(simulation)
    client.send("PARAM_REQUEST_LIST", target_system=1, target_component=1)
    simulation.advance(5.0)
    received = {m.fields.param_id.decode(): m.fields.param_value for m in client.receive() if m.name == "PARAM_VALUE"}
    assert len(received) == len(BOAT.firmware.table)
    assert received["BOAT_THROTTLE"] == 0.5


def test_it_sails_and_goes_back_to_a_snapshot(simulation: Simulation) -> None:
    client = _connect(simulation)
    client.command(ARM, 1.0)
    simulation.advance(2.0)
    before = simulation.snapshot()
    simulation.advance(8.0)
    first = bytes(simulation.snapshot().record)
    north = float(simulation.truth().lat)
    assert 10.0 < float(simulation.v.physics.body.pos[0]) < 20.0  # 2 m/s after a lag of 1 s
    simulation.restore(before)
    simulation.advance(8.0)
    assert bytes(simulation.snapshot().record) == first and float(simulation.truth().lat) == north


def test_what_it_lacks_is_named(boat: Kind) -> None:
    with pytest.raises(MissingPartError, match=r"vehicle 'boat' has no part 'logs', a sitl\.logs\.kind\.KindLogs"):
        logs_of("boat")
    with pytest.raises(EngineError, match="physics 'jsbsim' has no model of a boat; it is simulated by native"):
        Simulation(AIRFRAME, physics="jsbsim")


@pytest.mark.parametrize("name", BUILT_IN)
def test_every_part_of_a_built_in_kind_is_there(name: str) -> None:
    kind = KINDS[name]
    assert kind.name == name == kind.airframe.kind
    assert {"mavlink", "logs", "environments"} <= set(kind.parts)
    for part in kind.parts:
        assert kind.part(part, object) is not None
    assert "HEARTBEAT" in {message_of(law).kind.name for law in kind.part("mavlink", Profile).core.builders}
