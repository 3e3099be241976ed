# SPDX-License-Identifier: BSD-3-Clause
"""A link that several vehicles share: who hears whom, what a client that goes leaves behind."""

from __future__ import annotations

from typing import Any

import pytest

from sitl.bridge.dialect import message
from sitl.bridge.frame import encode_v1, encode_v2
from sitl.bridge.links import InProcessLink
from sitl.bridge.router import Router, split

HEARTBEAT = message("HEARTBEAT")


class Vehicle:
    """The part of a bridge that a router needs: it keeps the peers of its ends of links."""

    def __init__(self) -> None:
        self.links: list[Any] = []
        self.dropped: list[str] = []
        self.flushes = 0
        self.bridge: Any = self

    def add_link(self, link: Any) -> None:
        self.links.append(link)

    def flush(self) -> None:
        self.flushes += 1

    @property
    def peer(self) -> Any:
        return self.links[-1].peers[0]


def frame(system: int, version: int = 2) -> bytes:
    return (encode_v2 if version == 2 else encode_v1)(HEARTBEAT, HEARTBEAT.payload(), 0, system, 1)


@pytest.fixture
def vehicles() -> list[Vehicle]:
    return [Vehicle(), Vehicle(), Vehicle()]


def test_frames_are_cut_where_they_end() -> None:
    signed = bytearray(frame(3))
    signed[2] |= 1  # MAVLINK_IFLAG_SIGNED: 13 bytes more
    made = [frame(1), frame(2, 1), bytes(signed) + bytes(range(13)), frame(4)]
    assert split(b"".join(made)) == made
    assert split(b"") == []


def test_an_old_frame_is_never_taken_for_a_signed_one() -> None:
    """MAVLink 1 has its sequence where MAVLink 2 has its flags."""
    old = encode_v1(HEARTBEAT, HEARTBEAT.payload(), 1, 5, 1)
    assert split(old + frame(1)) == [old, frame(1)]


def test_all_vehicles_hear_a_client_and_it_hears_all_of_them(vehicles: list[Vehicle]) -> None:
    router, link = Router(vehicles), InProcessLink()
    ends = router.add_link(link)
    assert ends == [vehicle.links[0] for vehicle in vehicles]
    link.send(b"abc")
    router.receive()
    assert [vehicle.peer.take() for vehicle in vehicles] == [b"abc"] * 3
    assert router.received == 1
    router.receive()
    assert router.received == 1 and vehicles[0].peer.take() == b""
    for k in (2, 0, 1):
        vehicles[k].peer.accept(frame(k))
    router.flush()
    assert link.receive() == frame(0) + frame(1) + frame(2), "in the order of the vehicles"
    router.flush()
    assert link.receive() == b""


def test_a_link_of_some_vehicles(vehicles: list[Vehicle]) -> None:
    router, link = Router(vehicles), InProcessLink()
    ends = router.add_link(link, [2, 0])
    assert ends == [vehicles[2].links[0], vehicles[0].links[0]] and vehicles[1].links == []
    link.send(b"abc")
    router.receive()
    assert vehicles[2].peer.take() == b"abc"


def test_frames_that_were_queued_come_too(vehicles: list[Vehicle]) -> None:
    router, link = Router(vehicles[:1]), InProcessLink()
    router.add_link(link)
    peer = vehicles[0].peer
    assert peer.waits and peer.is_idle()
    peer.write(frame(7))
    assert not peer.is_idle()
    peer.flush()
    assert peer.is_idle()
    router.flush()
    assert link.receive() == frame(7)


def test_a_link_that_may_lose_frames_gets_them_one_by_one(vehicles: list[Vehicle]) -> None:
    router = Router(vehicles[:1])
    link = InProcessLink(drop_to_client=lambda raw: raw == frame(2))
    router.add_link(link)
    vehicles[0].peer.accept(frame(1) + frame(2) + frame(3))
    router.flush()
    assert link.receive() == frame(1) + frame(3)


def test_what_holds_of_a_client_holds_of_each_vehicles_end(
    vehicles: list[Vehicle], monkeypatch: pytest.MonkeyPatch
) -> None:
    """Signing, and whether telemetry waits for it."""
    router, link = Router(vehicles[:1]), InProcessLink()
    client = link.peers[0]
    client.is_signed = False
    router.add_link(link)
    assert (vehicles[0].peer.name, vehicles[0].peer.is_signed) == (client.name, False)
    assert vehicles[0].peer.congested is False
    monkeypatch.setattr(type(client), "congested", True)
    assert vehicles[0].peer.congested is True


def test_a_client_that_is_gone_is_gone_for_all_and_said_once(vehicles: list[Vehicle]) -> None:
    router, link, other = Router(vehicles), InProcessLink(), InProcessLink()
    router.add_link(link)
    router.add_link(other)
    peers = [vehicle.links[0].peers[0] for vehicle in vehicles]
    link.peers[0].closed, link.peers[0].why_closed = True, "it hung up"
    router.flush()
    assert [peer.closed for peer in peers] == [True] * 3
    assert [peer.why_closed for peer in peers] == ["it hung up", "", ""]
    assert [len(vehicle.links[0].peers) for vehicle in vehicles] == [0] * 3
    assert [vehicle.flushes for vehicle in vehicles] == [1] * 3
    link.send(b"abc")
    other.send(b"def")
    router.receive()
    assert vehicles[0].links[1].peers[0].take() == b"def" and peers[0].take() == b""
    router.flush()
    assert [vehicle.flushes for vehicle in vehicles] == [1] * 3


def test_who_was_turned_away_is_told_by_the_first_vehicle(vehicles: list[Vehicle]) -> None:
    router, link = Router(vehicles), InProcessLink()
    router.add_link(link)
    link.refusals.append("no space")
    router.receive()
    router.receive()
    assert [vehicle.dropped for vehicle in vehicles] == [["no space"], [], []]


def test_what_is_left_is_sent_before_links_close(vehicles: list[Vehicle]) -> None:
    router, link = Router(vehicles[:1]), InProcessLink()
    router.add_link(link)
    peer = link.peers[0]
    vehicles[0].peer.accept(frame(1))
    router.close()
    assert link.receive() == frame(1) and peer.closed and link.peers == []


def test_nothing_to_wait_for_is_no_news(vehicles: list[Vehicle]) -> None:
    assert Router(vehicles).wait(0.0) is False
