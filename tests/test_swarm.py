# SPDX-License-Identifier: BSD-3-Clause
"""Vehicles in one world see each other, collide and share the wind; they repeat bit for bit, in whatever order."""

from __future__ import annotations

import math
from collections.abc import Iterator

import numpy as np
import pytest

from sitl import Simulation, Swarm
from sitl.bridge.frame import Splitter
from sitl.bridge.links import InProcessLink
from sitl.client import Client, Endpoint
from sitl.client.swarm import clients_of
from sitl.errors import OptionError
from sitl.physics.native.records import GROUND_AIRBORNE
from sitl.swarm import SwarmSnapshot, plain
from sitl.vehicles import load
from sitl.worlds import Box, Start, World

NORTH = (-35.363262, 149.165237, 584.0, 0.0)
POSITION_ONLY, VELOCITY_ONLY = 0xDF8, 0x5C7
GUST = {"SIM_WIND_SPD": 3.0, "SIM_WIND_TURB": 1.5}


def positions(swarm: Swarm) -> list[tuple[float, float, float]]:
    return [tuple(vehicle.v.physics.body.pos) for vehicle in swarm.vehicles]


def records(swarm: Swarm) -> list[bytes]:
    return [vehicle.snapshot().record for vehicle in swarm.vehicles]


def hits(swarm: Swarm) -> list[int]:
    return [vehicle.v.physics.obstacles.hit_count for vehicle in swarm.vehicles]


def senders(link: InProcessLink, name: str = "HEARTBEAT") -> set[int]:
    """System ids of those that have sent a message."""
    return {frame.system for frame in Splitter().feed(link.receive()) if frame.kind.name == name}


class Pair:
    """Two copters in the air, 5 m high and 6 m apart, which know where they are."""

    def __init__(self) -> None:
        self.swarm = Swarm("erle_copter", 2, spacing=6.0, home=NORTH, estimator="truth", params=GUST)
        self.clients = clients_of(self.swarm)
        for client in self.clients:
            client.wait_ready()
            client.take_off(5.0)
        self.hover: SwarmSnapshot = self.swarm.snapshot()

    def fly_into_each_other(self, seconds: float = 5.0, step: float = 0.1) -> None:
        """Each is sent to behind the other one; they are advanced in steps [s]."""
        for client, east in zip(self.clients, (20.0, -14.0), strict=True):
            client.send("SET_POSITION_TARGET_LOCAL_NED", coordinate_frame=1, type_mask=POSITION_ONLY, y=east, z=-5.0)
        for _ in range(round(seconds / step)):
            self.swarm.advance(step)


@pytest.fixture(scope="module")
def flying() -> Iterator[Pair]:
    pair = Pair()
    yield pair
    pair.swarm.close()


@pytest.fixture
def pair(flying: Pair) -> Pair:
    flying.swarm.restore(flying.hover)
    flying.swarm.order = range(2)
    for client in flying.clients:
        client.connection.endpoint.link.receive()
        client.connection.endpoint.sequence = 0
    return flying


def test_vehicles_stand_on_a_grid_with_system_ids() -> None:
    swarm = Swarm("erle_copter", 5, spacing=3.0, home=(*NORTH[:3], 90.0))
    heard = [InProcessLink() for _ in swarm.vehicles]
    for vehicle, link in zip(swarm.vehicles, heard, strict=True):
        vehicle.bridge.add_link(link)
    swarm.advance(1.0)
    expected = [(0, 0), (-3, 0), (-6, 0), (0, -3), (-3, -3)]  # to the right of east is south, behind it west
    for (north, east), place in zip(expected, positions(swarm), strict=True):
        assert place == pytest.approx((north, east, 0.0), abs=1e-6)
    for k, link in enumerate(heard):
        data = link.receive()
        assert data[0] == 0xFD and data[5] == k + 1


def test_a_vehicle_alone_flies_as_ever() -> None:
    """Its sensors draw the same noise, and its body moves by the same bits."""
    params = {"MAV_SYSID": 1.0}
    alone = Simulation("erle_copter", world=plain(0.0), home=NORTH, seed=4, params=params)
    swarm = Swarm("erle_copter", 1, home=NORTH, seed=4)
    both = [Client(alone), *clients_of(swarm)]
    for client in both:
        client.wait_ready()
        client.take_off(3.0)
    (ours,) = swarm.vehicles
    assert tuple(ours.v.physics.body.pos) == tuple(alone.v.physics.body.pos)
    assert bytes(ours.v.sensors._bytes) == bytes(alone.v.sensors._bytes)


def test_two_that_are_sent_into_each_other_collide(pair: Pair) -> None:
    radius, top, bottom = (float(load("erle_copter").value(f"contact_{name}")) for name in ("radius", "top", "bottom"))
    pair.fly_into_each_other(0.5)
    for _ in range(1800):
        pair.swarm.advance(0.0025)
        one, two = positions(pair.swarm)
        level = math.hypot(one[0] - two[0], one[1] - two[1]) - 2.0 * radius
        assert max(level, abs(one[2] - two[2]) - top - bottom) > -1e-6
    assert min(hits(pair.swarm)) >= 1
    assert max(vehicle.v.physics.obstacles.hit_speed for vehicle in pair.swarm.vehicles) > 0.1


def test_a_collision_keeps_momentum(pair: Pair) -> None:
    """At the tick of the first touch: what one loses the other gains, and they no longer approach."""
    swarm = pair.swarm
    pair.fly_into_each_other(1.0)
    before = [vehicle.v.physics.body.vel for vehicle in swarm.vehicles]
    for _ in range(1000):
        before = [vehicle.v.physics.body.vel for vehicle in swarm.vehicles]
        swarm.advance(0.0025)
        if sum(hits(swarm)):
            break
    assert hits(swarm) == [1, 1]
    one, two = (vehicle.v.physics.body.vel for vehicle in swarm.vehicles)
    assert before[0].y - before[1].y > 2.0
    assert one.y - two.y < 0.1
    assert one.y + two.y == pytest.approx(before[0].y + before[1].y, abs=0.05)


def test_a_hit_is_told(pair: Pair) -> None:
    pair.fly_into_each_other()
    for client in pair.clients:
        client.delay(0.1)
        assert any("hit" in text.text.lower() for text in client.texts), client.texts


def test_neither_order_nor_steps_change_a_bit(pair: Pair) -> None:
    pair.fly_into_each_other()
    first = records(pair.swarm)
    pair.swarm.restore(pair.hover)
    for client in pair.clients:
        client.connection.endpoint.sequence = 0
    pair.swarm.order = (1, 0)
    pair.fly_into_each_other(step=0.0125)
    assert records(pair.swarm) == first


def test_gusts_are_the_same_for_all(pair: Pair) -> None:
    pair.swarm.advance(1.0)
    one, two = (vehicle.v.physics.wind for vehicle in pair.swarm.vehicles)
    before = one.gust
    assert before != (0.0, 0.0, 0.0) and one.gust == two.gust
    pair.swarm.advance(1.0)
    assert one.gust == two.gust != before


def test_wind_that_is_set_at_one_blows_for_all(pair: Pair) -> None:
    pair.clients[1].params.update({"SIM_WIND_SPD": 8.0, "SIM_WIND_DIR": 90.0, "SIM_WIND_T": 1.0})
    pair.swarm.advance(40.0)
    for vehicle in pair.swarm.vehicles:
        assert vehicle.parameters["SIM_WIND_SPD"] == 8.0
        assert vehicle.v.physics.wind.steady.y == pytest.approx(-8.0, abs=0.5)


def test_a_swarm_goes_on_from_a_snapshot_within_a_slice(pair: Pair) -> None:
    pair.fly_into_each_other(1.0)
    pair.swarm.advance(0.0075)
    held = pair.swarm.snapshot()
    pair.swarm.advance(2.0)
    first = records(pair.swarm)
    pair.swarm.restore(held)
    pair.swarm.advance(2.0)
    assert records(pair.swarm) == first


def test_another_seed_is_another_swarm() -> None:
    ends = []
    for seed in (1, 1, 2):
        swarm = Swarm(["erle_copter", "erle_rover_small"], home=NORTH, seed=seed, params=GUST)
        swarm.advance(1.0)
        ends.append(records(swarm))
    assert ends[0] == ends[1] != ends[2]


def test_lidar_and_rangefinder_meet_other_vehicles() -> None:
    """A rover 4 m before a copter; then the copter falls from 3 m above it."""
    swarm = Swarm(["erle_copter", "erle_rover"], starts=[(0, 0, 0, 0), (4, 0, 0, 0)], home=NORTH)
    copter, rover = swarm.vehicles
    swarm.advance(0.5)
    a, body, there = rover.airframe, copter.v.physics.body, rover.v.physics.body.pos
    readings = np.array(copter.v.sensors.lidar_ranges)[:70]
    lidar = body.pos.x + float(copter.airframe.value("lidar_at")[0])
    front = there.x + float(np.min(a.value("contact_along"))) - float(a.value("contact_radius"))
    assert float(readings.min()) == pytest.approx(front - lidar, abs=0.02)
    assert abs(int(readings.argmin()) - 35) <= 4
    assert float(readings[0]) >= 10.0
    body.pos = (there.x, 0.0, -3.0)
    copter.v.physics.ground.state = GROUND_AIRBORNE
    swarm.advance(0.1)
    read = float(copter.v.sensors.rangefinder_range[0])
    assert read == pytest.approx(-body.pos.z - float(a.value("contact_top")), abs=0.1)


def test_a_copter_that_falls_on_a_rover_comes_to_rest_there() -> None:
    swarm = Swarm(["erle_copter", "erle_rover"], starts=[(10, 0, 0, 0), (0, 0, 0, 0)], home=NORTH)
    copter, rover = swarm.vehicles
    swarm.advance(0.5)
    body = copter.v.physics.body
    body.pos = (0.0, 0.0, -2.0)
    copter.v.physics.ground.state = GROUND_AIRBORNE
    swarm.advance(3.0)
    top = float(rover.airframe.value("contact_top")) + float(copter.airframe.value("contact_bottom"))
    assert -body.pos.z == pytest.approx(top, abs=0.01)
    assert abs(body.vel.z) < 0.05
    assert rover.v.physics.body.pos.z == 0.0
    assert copter.v.physics.obstacles.hit_count >= 1


def test_a_rover_pushes_another_one() -> None:
    swarm = Swarm("skid_rover", 2, starts=[(0, 0, 0, 0), (3, 0, 0, 0)], home=NORTH, estimator="truth")
    behind, _ = clients_of(swarm)
    behind.wait_ready()
    behind.set_mode("GUIDED")
    behind.arm()
    before = positions(swarm)
    for _ in range(8):
        behind.send("SET_POSITION_TARGET_LOCAL_NED", coordinate_frame=1, type_mask=VELOCITY_ONLY, vx=1.0)
        swarm.advance(1.0)
    one, two = positions(swarm)
    along, radius = (swarm[0].airframe.value(f"contact_{name}") for name in ("along", "radius"))
    assert one[0] > before[0][0] + 1.5
    assert two[0] - one[0] >= 2.0 * (float(np.max(along)) + float(radius)) - 0.02
    assert two[0] > before[1][0] + 0.01
    assert min(hits(swarm)) >= 1


def test_one_link_for_all_and_one_for_one() -> None:
    swarm = Swarm("erle_copter", 3, home=NORTH)
    shared, own = InProcessLink(), InProcessLink()
    swarm.router.add_link(shared)
    swarm.router.add_link(own, [1])
    station = Endpoint(shared)
    swarm.advance(1.5)
    assert senders(shared) == {1, 2, 3}
    assert senders(own) == {2}
    station.send(
        "PARAM_SET", target_system=3, target_component=1, param_id=b"WP_YAW_BEHAVIOR", param_value=3.0, param_type=2
    )
    station.command(400, 1.0, 21196.0, target=0)
    swarm.advance(0.1)
    assert [vehicle.parameters["WP_YAW_BEHAVIOR"] == 3.0 for vehicle in swarm.vehicles] == [False, False, True]
    assert senders(shared, "COMMAND_ACK") == {1, 2, 3}
    swarm.vehicles[0].request_reboot()
    swarm.advance(1.5)
    assert senders(shared) == {1, 2, 3}


def test_what_cannot_be_a_swarm_is_refused() -> None:
    wall = World("walled", (Box((0.0, 0.0, 0.5), (1.0, 1.0, 1.0), name="wall"),), (Start("s", (5.0, 0.0, 0.0), 0.0),))
    for options, needed in (
        ({"count": 0}, "1 .. 250"),
        ({"count": 251}, "1 .. 250"),
        ({"count": 2, "spacing": 0.0}, "spacing"),
        ({"count": 2, "spacing": 0.3}, "are needed"),
        ({"count": 2, "starts": [(0, 0, 0, 0)]}, "start poses"),
        ({"count": 1, "world": wall, "starts": [(0, 0, 0, 0)]}, "solid wall"),
    ):
        with pytest.raises(OptionError, match=needed):
            Swarm("erle_copter", **options)  # type: ignore[arg-type]
    with pytest.raises(OptionError, match="a frame for each"):
        Swarm(["erle_copter"], 2)


def test_a_copter_follows_another_one() -> None:
    """FOLLOW takes the lead's GLOBAL_POSITION_INT, which comes by radio; without FOLL_ENABLE it does not."""
    swarm = Swarm("erle_copter", 3, spacing=6.0, home=NORTH)
    lead, behind, _ = clients_of(swarm)
    behind.params.update({"FOLL_ENABLE": 1, "FOLL_SYSID": 1, "FOLL_OFS_X": -5, "FOLL_OFS_TYPE": 0, "FOLL_ALT_TYPE": 1})
    for client in (lead, behind):
        client.wait_ready()
        client.take_off(5.0)
    behind.set_mode("FOLLOW")
    for east in (20.0, 40.0):
        lead.send("SET_POSITION_TARGET_LOCAL_NED", coordinate_frame=1, type_mask=POSITION_ONLY, y=east, z=-5.0)
        swarm.advance(15.0)
    one, two, _ = positions(swarm)
    assert one[1] > 35.0
    assert two[0] - one[0] == pytest.approx(-5.0, abs=1.0) and two[1] - one[1] == pytest.approx(0.0, abs=1.0)
    assert swarm[1].v.autopilot.modes.follow.sender == 1
    assert swarm[2].v.autopilot.modes.follow.sender == 0
