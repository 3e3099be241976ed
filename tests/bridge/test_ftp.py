# SPDX-License-Identifier: BSD-3-Clause
"""MAVLink FTP: what MAVProxy does to get all parameters at once."""

from __future__ import annotations

import struct

import pytest
from pymavlink.dialects.v20 import ardupilotmega as mavlink
from pymavlink.mavftp import MAVFTP

from sitl.autopilot.copter.parameters import TABLE
from tests.bridge.fakes import Bench

HEADER = struct.Struct("<HBBBBBBI")
OPEN, READ, BURST, LIST, ACK, NAK = 4, 5, 15, 3, 128, 129


def request(
    opcode: int, data: bytes = b"", offset: int = 0, size: int | None = None, sequence: int = 5, session: int = 0
) -> object:
    head = HEADER.pack(sequence, session, opcode, len(data) if size is None else size, 0, 0, 0, offset)
    return mavlink.MAVLink_file_transfer_protocol_message(0, 1, 1, list((head + data).ljust(251, b"\0")))


def unpack(message: object) -> tuple[tuple[int, ...], bytes]:
    raw = bytes(message.payload)  # type: ignore[attr-defined]
    head = HEADER.unpack_from(raw)
    return head, raw[HEADER.size : HEADER.size + head[3]]


def fetch(bench: Bench, path: bytes) -> bytes:
    (answer,) = bench.ask(request(OPEN, path))
    head, data = unpack(answer)
    assert (head[0], head[2], head[4]) == (6, ACK, OPEN)
    size = struct.unpack("<I", data)[0]
    bench.client.send(request(BURST, size=239, sequence=7))
    found = bytearray()
    complete = 0
    for _ in range(1000):
        bench.run(0.02)
        for message in bench.client.receive("FILE_TRANSFER_PROTOCOL"):
            head, data = unpack(message)
            assert head[7] == len(found) and head[2] == ACK and not complete
            found += data
            complete = head[5]
        if complete:
            break
    assert len(found) == size
    return bytes(found)


@pytest.mark.parametrize("query", [b"", b"?withdefaults=1"])
def test_all_parameters(bench: Bench, query: bytes) -> None:
    bench.vehicle.v.autopilot.params.MAV_GCS_SYSID = 250.0
    decoded = MAVFTP.ftp_param_decode(fetch(bench, b"@PARAM/param.pck" + query))
    values = {name.decode(): value for name, value, _ in decoded.params}
    assert len(values) == len(TABLE)
    for p in TABLE:
        assert values[p.name] == pytest.approx(bench.vehicle.v.autopilot.params[p.name], rel=1e-6)
    if query:
        defaults = {name.decode(): value for name, value, _ in decoded.defaults}
        assert defaults["MAV_GCS_SYSID"] == 255.0 and values["MAV_GCS_SYSID"] == 250.0


def test_read_in_pieces(bench: Bench) -> None:
    whole = fetch(bench, b"@PARAM/param.pck")
    (answer,) = bench.ask(request(READ, offset=100, size=50))
    assert unpack(answer)[1] == whole[100:150]
    (answer,) = bench.ask(request(READ, offset=len(whole), size=50))
    assert unpack(answer) == ((6, 0, NAK, 1, READ, 0, 0, 0), b"\x06")


@pytest.mark.parametrize(("message", "error"), [
    (request(OPEN, b"@SYS/tasks.txt"), 10), (request(OPEN, b"\xff\xfe"), 10), (request(LIST, b"/"), 7),
    (request(16), 7),
    (request(READ, size=10), 4), (request(BURST, size=10), 4), (request(OPEN, size=255), 3),
])  # fmt: skip
def test_refusals(bench: Bench, message: object, error: int) -> None:
    (answer,) = bench.ask(message)
    head, data = unpack(answer)
    assert head[2] == NAK and data == bytes((error,))


def test_the_client_numbers_its_sessions(bench: Bench) -> None:
    """MAVProxy begins anywhere, counts up and ignores answers under another number."""
    (answer,) = bench.ask(request(OPEN, b"@PARAM/param.pck", session=147))
    assert unpack(answer)[0][1:3] == (147, ACK)
    (answer,) = bench.ask(request(1, session=146))
    assert unpack(answer)[0][1:3] == (146, ACK)
    (answer,) = bench.ask(request(READ, size=10, session=147))
    assert unpack(answer)[0][1:3] == (147, ACK)
    (answer,) = bench.ask(request(READ, size=10, session=148))
    assert unpack(answer)[0][1:3] == (148, NAK)
