# SPDX-License-Identifier: BSD-3-Clause
"""The same bytes at the same simulated times give the same bytes."""

from __future__ import annotations

import random

from pymavlink.dialects.v20 import ardupilotmega as mavlink

from sitl.client.endpoint import Endpoint
from sitl.missions.pilot import Pilot
from sitl.simulation import Core, Simulation
from tests.bridge.fakes import Bench


def session(seed: int) -> bytes:
    """A busy minute with two clients; everything that was sent to them."""
    rng = random.Random(seed)
    bench = Bench()
    bench.vehicle.locate()
    bench.vehicle.v.autopilot.modes.number = 4
    other = bench.connect(system=250)
    heard = b""
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
        heard += bench.client.link.receive() + other.link.receive()
    return heard


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
    heard = []
    for step in (0.0025, 0.13, 20.0):
        pilot.simulation.restore(start)
        stop = pilot.simulation.time_us + 20_000_000
        while pilot.simulation.time_us < stop:
            pilot.simulation.advance_to(min(stop, pilot.simulation.time_us + round(step * 1e6)))
        heard.append(listener.link.receive())
    assert heard[0] == heard[1] == heard[2]
    assert b"Disarming motors" in heard[0] and b"SIM Hit ground" in heard[0]
