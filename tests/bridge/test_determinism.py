# SPDX-License-Identifier: BSD-3-Clause
"""The same bytes at the same simulated times give the same bytes, also after a restore."""

from __future__ import annotations

import pickle
import random
from collections.abc import Callable

import pytest
from pymavlink.dialects.v20 import ardupilotmega as mavlink

from benchmarks.recorded.pilot import VELOCITY_ONLY, Pilot
from sitl.client.endpoint import Endpoint
from sitl.simulation import Core, Simulation
from tests.bridge.fakes import Bench


def session(seed: int) -> bytes:
    """A busy minute with two clients; everything that was sent to them."""
    rng = random.Random(seed)
    bench = Bench()
    bench.vehicle.locate()
    bench.vehicle.v.autopilot.modes.number = 4
    other = bench.connect(system=250)
    received = b""
    for _ in range(200):
        client = rng.choice((bench.client, other))
        client.send(rng.choice((
            mavlink.MAVLink_request_data_stream_message(1, 1, rng.choice((0, 6, 10)), rng.randint(0, 20), 1),
            mavlink.MAVLink_param_request_list_message(1, 1),
            mavlink.MAVLink_param_set_message(1, 1, b"MAV_GCS_SYSID", rng.randint(0, 300), 9),
            mavlink.MAVLink_command_long_message(1, 1, 511, 0, 30, rng.choice((33_333, -1)), *(0,) * 5),
            mavlink.MAVLink_mission_count_message(1, 1, 3),
            mavlink.MAVLink_timesync_message(0, rng.randint(0, 2**40)),
        )))  # fmt: skip
        bench.vehicle.v.autopilot.estimate.pos = [rng.uniform(-100, 100) for _ in range(3)]
        bench.run(rng.choice((0.0025, 0.05, 0.3)))
        received += bench.client.link.receive() + other.link.receive()
    return received


def test_repeats_are_identical() -> None:
    first = session(3)
    assert first == session(3)
    assert len(first) > 100_000
    assert first != session(4)


def test_stopping_more_often_changes_nothing() -> None:
    def flight(step: float) -> bytes:
        bench = Bench()
        bench.command(511, 30, 20_000)
        for _ in range(round(10.0 / step)):
            bench.run(step)
        return bench.client.link.receive()

    assert flight(10.0) == flight(0.0025) == flight(0.1)


def test_after_a_restore_streams_go_on_from_the_restored_time() -> None:
    bench = Bench()
    bench.command(511, 30, 20_000)
    bench.run(5.0)
    keep, state = bench.vehicle.fleet.copy(), bench.bridge.snapshot()
    bench.client.receive()
    bench.run(1.0)
    first = bench.client.link.receive()
    bench.vehicle.fleet[:] = keep
    bench.bridge.restore(state)
    bench.run(1.0)
    assert first == bench.client.link.receive()


def test_a_reboot_keeps_clients_and_forgets_their_streams() -> None:
    bench = Bench()
    bench.command(511, 30, 20_000)
    bench.run(5.0)
    bench.client.receive()
    bench.vehicle.v.time_us = 0
    old = bench.bridge
    bench.bridge = old.successor()
    bench.run(3.0)
    types = {m.get_type() for m in bench.client.receive()}
    assert "HEARTBEAT" in types and "ATTITUDE" not in types
    assert len(bench.bridge.channels) == 1


def test_every_byte_of_a_flight_has_its_time_whatever_the_step(core: Core) -> None:
    """Texts of take-off, landing and disarming included: the core stops for them."""
    pilot = Pilot(Simulation(core=core))
    pilot.boot()
    pilot.arm()
    listener = Endpoint()
    pilot.simulation.bridge.add_link(listener.link)
    listener.set_interval("ATTITUDE", 4.0)
    pilot.send_command("NAV_TAKEOFF", altitude=2.0)
    pilot.fly(6.0)
    pilot.send_command("NAV_LAND")
    pilot.fly(0.1)
    listener.link.receive()
    start = pilot.simulation.snapshot()
    received = []
    for step in (0.0025, 0.13, 20.0):
        pilot.simulation.restore(start)
        stop = pilot.simulation.time_us + 20_000_000
        while pilot.simulation.time_us < stop:
            pilot.simulation.advance_to(min(stop, pilot.simulation.time_us + round(step * 1e6)))
        received.append(listener.link.receive())
    assert received[0] == received[1] == received[2]
    assert b"Disarming motors" in received[0] and b"SIM Hit ground" in received[0]


TARGET = {"target_system": 1, "target_component": 1}
Script = Callable[[Endpoint], None]


@pytest.fixture
def flying(core: Core) -> Pilot:
    """A copter in the climb, a client with four messages at two rates."""
    pilot = Pilot(Simulation(core=core))
    pilot.boot()
    pilot.arm()
    pilot.send_command("NAV_TAKEOFF", altitude=5.0)
    pilot.fly(3.0)
    pilot.connection.endpoint.link.receive()
    return pilot


def record(pilot: Pilot, script: Script, seconds: float = 3.0) -> bytes:
    """Every byte that the client gets from now on, in steps of 0.1 s with the script at each."""
    received = b""
    for _ in range(round(seconds * 10)):
        script(pilot.connection.endpoint)
        pilot.simulation.advance(0.1)
        received += pilot.connection.endpoint.link.receive()
    return received


def set_velocity(client: Endpoint) -> None:
    client.send("SET_POSITION_TARGET_LOCAL_NED", **TARGET, coordinate_frame=1, type_mask=VELOCITY_ONLY, vx=1.0)


def disturb(pilot: Pilot) -> None:
    """Change everything that a snapshot has to bring back."""
    client = pilot.connection.endpoint
    client.command(511, 30, 33_333)
    client.command(511, 32, -1)
    client.send("REQUEST_DATA_STREAM", **TARGET, req_stream_id=0, req_message_rate=7, start_stop=1)
    client.send("PARAM_REQUEST_LIST", **TARGET)
    client.send("MISSION_COUNT", **TARGET, count=3)
    client.send("PARAM_SET", **TARGET, param_id=b"MAV_SYSID", param_value=9, param_type=2)
    pilot.simulation.advance(1.0)
    client.command(400, 0, 21196, target=9)
    pilot.simulation.advance(0.37)
    pilot.connection.endpoint.link.receive()


def test_the_same_bytes_again(flying: Pilot) -> None:
    snapshot = flying.simulation.snapshot()
    first = record(flying, set_velocity)
    disturb(flying)
    flying.simulation.restore(snapshot)
    assert record(flying, set_velocity) == first
    assert len(first) > 5000
    flying.simulation.restore(snapshot)
    assert record(flying, lambda client: None) != first


@pytest.mark.parametrize("wait", [0.0025, 0.02, 0.1])
def test_in_the_middle_of_everything(flying: Pilot, wait: float) -> None:
    """A parameter list, a mission upload and events half way."""
    client = flying.connection.endpoint
    client.send("PARAM_REQUEST_LIST", **TARGET)
    client.send("MISSION_COUNT", **TARGET, count=2)
    client.send("PARAM_SET", **TARGET, param_id=b"ANGLE_MAX", param_value=1e9, param_type=4)
    flying.simulation.advance(wait)
    client.send("MISSION_ITEM_INT", **TARGET, seq=0, frame=0, command=16, x=-353632620, y=1491652370)
    flying.simulation.advance(wait)
    client.link.receive()
    snapshot = flying.simulation.snapshot()

    def finish(client: Endpoint) -> None:
        client.send("MISSION_ITEM_INT", **TARGET, seq=1, frame=3, command=22, z=10.0)

    first = record(flying, finish)
    disturb(flying)
    flying.simulation.restore(snapshot)
    assert record(flying, finish) == first
    assert len(flying.simulation.mission) == 2


def test_from_power_on(core: Core) -> None:
    simulation = Simulation(core=core)
    listener = Endpoint()
    simulation.bridge.add_link(listener.link)
    snapshot = simulation.snapshot()
    simulation.advance(7.0)
    first = listener.link.receive()
    assert b"ArduPilot Ready" in first
    simulation.restore(snapshot)
    simulation.advance(7.0)
    assert listener.link.receive() == first


def test_across_a_reboot(flying: Pilot) -> None:
    snapshot = flying.simulation.snapshot()
    first = record(flying, set_velocity)
    flying.connection.endpoint.command(400, 0, 21196)
    flying.connection.endpoint.command(246, 1)
    flying.simulation.advance(5.0)
    assert int(flying.simulation.v.time_us) < 6_000_000
    flying.connection.endpoint.link.receive()
    flying.simulation.restore(snapshot)
    assert record(flying, set_velocity) == first


def test_a_new_client_stays(flying: Pilot) -> None:
    snapshot = flying.simulation.snapshot()
    first = record(flying, set_velocity)
    late = Endpoint(system=250)
    flying.simulation.bridge.add_link(late.link)
    late.set_interval("ATTITUDE", 20.0)
    record(flying, set_velocity)
    late.receive()
    flying.simulation.restore(snapshot)
    assert record(flying, set_velocity) == first
    assert sum(m.name == "ATTITUDE" for m in late.receive()) == 60


def test_a_snapshot_is_not_changed_by_what_follows(flying: Pilot) -> None:
    snapshot = flying.simulation.snapshot()
    kept = hash(snapshot)  # immutable all the way down
    record(flying, set_velocity, 1.0)
    disturb(flying)
    assert hash(snapshot) == kept
    assert pickle.loads(pickle.dumps(snapshot)) == snapshot


def test_another_simulation_goes_on_with_it(flying: Pilot, core: Core) -> None:
    """A fork: the same airframe, a client in the same place."""
    snapshot = flying.simulation.snapshot()
    first = record(flying, set_velocity)
    other = Pilot(Simulation(core=core, seed=99))
    other.fly(0.1)  # what its client sent at first is read
    other.simulation.restore(snapshot)
    other.connection.endpoint.link.receive()
    assert record(other, set_velocity) == first
