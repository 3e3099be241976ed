# SPDX-License-Identifier: BSD-3-Clause
"""The relay between an autopilot's TCP port and clients, turn by turn, and how it cuts a stream into frames."""

from __future__ import annotations

import socket

import pytest

from sitl.bridge.dialect import message
from sitl.bridge.frame import encode_v1, encode_v2
from sitl.bridge.links.inprocess import InProcessLink
from sitl.foreign.process import Cutter
from sitl.foreign.relay import Relay, UdpRelay

HEARTBEAT = message("HEARTBEAT")


def frame(number: int) -> bytes:
    return encode_v2(HEARTBEAT, HEARTBEAT.payload(custom_mode=number), number, 1, 1)


UNKNOWN = b"\xfd\x03\x00\x00\x00\x01\x01\xff\xff\x00abcXY"
SIGNED = b"\xfd\x01\x01\x00\x00\x01\x01\x00\x00\x00aXY" + b"s" * 13


@pytest.mark.parametrize("piece", [1, 3, 7, 1000])
def test_a_stream_is_cut_into_frames_whatever_they_are(piece):
    frames = [frame(1), UNKNOWN, SIGNED, encode_v1(HEARTBEAT, HEARTBEAT.payload(), 0, 1, 1), frame(2)]
    stream, cutter = b"noise" + b"".join(frames), Cutter()
    found = [made for at in range(0, len(stream), piece) for made in cutter.feed(stream[at : at + piece])]
    assert found == frames


class Autopilot:
    """Listens for MAVLink as ArduPilot does."""

    def __init__(self, port: int = 0) -> None:
        self.server = socket.create_server(("127.0.0.1", port), reuse_port=False)
        self.server.settimeout(5.0)
        self.address = self.server.getsockname()[:2]

    def accept(self) -> socket.socket:
        connection, _ = self.server.accept()
        connection.settimeout(5.0)
        return connection


def test_frames_pass_both_ways_and_the_tap_sees_them():
    autopilot, link, seen = Autopilot(), InProcessLink(), []
    relay = Relay(autopilot.address, [link], seen.append)
    relay.turn(0.0)
    connection = autopilot.accept()
    connection.sendall(frame(1)[:5])
    relay.turn(1.0)
    assert link.receive() == b""
    connection.sendall(frame(1)[5:] + frame(2))
    relay.turn(1.0)
    assert link.receive() == frame(1) + frame(2)
    link.send(frame(3))
    relay.turn(0.0)
    assert connection.recv(1000) == frame(3)
    assert seen == [frame(1), frame(2), frame(3)] and relay.frames == 2 and relay.is_connected
    connection.close()
    relay.close()
    autopilot.server.close()


def test_the_relay_finds_an_autopilot_that_boots_again():
    autopilot, link = Autopilot(), InProcessLink()
    relay = Relay(autopilot.address, [link])
    relay.turn(0.0)
    autopilot.accept().close()
    relay.turn(1.0)
    assert not relay.is_connected
    link.send(frame(9))  # lost: nobody is there
    while not relay.is_connected:
        relay.turn(0.05)
    connection = autopilot.accept()
    connection.sendall(frame(4))
    relay.turn(1.0)
    assert link.receive() == frame(4)
    connection.close()
    relay.close()
    autopilot.server.close()


def test_datagrams_pass_both_ways_and_what_is_answered_does_not_reach_the_autopilot():
    autopilot, link, seen = socket.socket(socket.AF_INET, socket.SOCK_DGRAM), InProcessLink(), []
    autopilot.bind(("127.0.0.1", 0))
    autopilot.settimeout(5.0)
    answers = {frame(3): frame(4)}
    relay = UdpRelay(autopilot.getsockname()[1], [link], seen.append, lambda asked: answers.get(asked, b""))
    autopilot.sendto(frame(1) + frame(2), ("127.0.0.1", relay.own_port))
    relay.turn(1.0)
    assert link.receive() == frame(1) + frame(2) and relay.frames == 2
    link.send(frame(3) + frame(5))
    relay.turn(0.0)
    assert autopilot.recv(1000) == frame(5) and link.receive() == frame(4)
    assert seen == [frame(1), frame(2), frame(3), frame(4), frame(5)]
    with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as stranger:
        stranger.sendto(frame(6), ("127.0.0.1", relay.own_port))
        relay.turn(0.2)
    assert link.receive() == b""
    autopilot.close()
    relay.turn(0.0)
    relay.close()
