# SPDX-License-Identifier: BSD-3-Clause
"""Parameters by their own protocol, and all at once by MAVLink FTP, as MAVProxy gets them."""

from __future__ import annotations

import json
import math
import random
import struct
from typing import Any

import numpy as np
import pytest
from pymavlink.dialects.v20 import ardupilotmega as mavlink
from pymavlink.mavftp import MAVFTP

from sitl.autopilot.copter.parameters import TABLE
from sitl.autopilot.params.parameter import stored
from sitl.bridge.frame import Splitter
from sitl.bridge.metadata import file_crc
from sitl.bridge.services.parameter_protocol import pack_parameters
from tests.bridge.fakes import Bench, Client


def read(bench: Bench, name: str = "", index: int = -1) -> list[object]:
    return bench.ask(mavlink.MAVLink_param_request_read_message(1, 1, name.encode(), index))


def write(bench: Bench, name: str, value: float, kind: int = 9) -> list[object]:
    return bench.ask(mavlink.MAVLink_param_set_message(1, 1, name.encode(), value, kind))


def names(bench: Bench) -> list[str]:
    """Those in the list."""
    return [p.name for p in bench.vehicle.parameters.listed()]


def test_read_by_name_and_index(bench: Bench) -> None:
    (answer,) = read(bench, "MAV_GCS_SYSID")
    assert (answer.param_id, answer.param_value, answer.param_type) == ("MAV_GCS_SYSID", 255.0, 4)
    listed = names(bench)
    assert (answer.param_index, answer.param_count) == (65535, len(listed))
    (answer,) = read(bench, index=listed.index("MAV_GCS_SYSID"))
    assert (answer.param_id, answer.param_index) == ("MAV_GCS_SYSID", listed.index("MAV_GCS_SYSID"))
    (answer,) = read(bench, index=len(listed))
    assert answer.get_type() == "PARAM_ERROR"


def test_set_truncates_integers_and_tells_everyone(bench: Bench) -> None:
    other = bench.connect(system=250)
    (answer,) = write(bench, "MAV_GCS_SYSID", 33.7)
    assert (answer.param_value, answer.param_index) == (33.0, 65535)
    assert [m.param_value for m in other.receive("PARAM_VALUE")] == [33.0]
    assert bench.vehicle.v.autopilot.params.MAV_GCS_SYSID == 33.0
    assert ("parameter_changed", "MAV_GCS_SYSID") in bench.autopilot.calls


@pytest.mark.parametrize(("value", "kept"), [(300, 127), (-300, -128), (33.7, 33), (-33.7, -33)])
def test_integers_stop_at_the_ends_of_their_type(bench: Bench, value: float, kept: int) -> None:
    """As a real ArduPilot answers for an INT8; of one with a range of its own the nearest value in range is used."""
    assert write(bench, "FRSKY_OPTIONS", value)[-1].param_value == kept
    assert write(bench, "DISARM_DELAY", value)[-1].param_value == kept
    assert max(kept, 0) == bench.vehicle.v.autopilot.params.DISARM_DELAY


def test_a_value_out_of_range_is_kept_and_the_nearest_in_range_is_used(bench: Bench) -> None:
    *texts, answer = write(bench, "GUID_TIMEOUT", 7200.0)
    assert "".join(m.text for m in texts) == "GUID_TIMEOUT: 7200 is outside 0.1 .. 3600 s: 3600 is used"
    assert answer.param_value == 7200.0
    assert bench.vehicle.v.autopilot.params.GUID_TIMEOUT == 3600.0
    assert [m.param_value for m in read(bench, "GUID_TIMEOUT")] == [7200.0]
    (answer,) = write(bench, "GUID_TIMEOUT", 7200.0)
    assert answer.param_value == 7200.0, "told once"
    (answer,) = write(bench, "GUID_TIMEOUT", 5.0)
    assert answer.param_value == 5.0 == bench.vehicle.v.autopilot.params.GUID_TIMEOUT
    assert "GUID_TIMEOUT" not in bench.vehicle.parameters.kept


@pytest.mark.parametrize("kind", ["bench", "rover_bench"])
def test_every_bound_is_taken_without_a_word(kind: str, request: pytest.FixtureRequest) -> None:
    """As PARAM_SET carries it: in single precision."""
    bench: Bench = request.getfixturevalue(kind)
    for p in bench.vehicle.parameters.table:
        for bound in filter(math.isfinite, (p.low, p.high)):
            if p.read_only or p.name == "MAV_SYSID":
                continue
            answers = write(bench, p.name, bound)
            said = [m.text for m in answers if m.get_type() == "STATUSTEXT" and p.name in m.text]
            assert not said and answers[-1].param_value == np.float32(stored(p, bound)), p


@pytest.mark.parametrize("value", [math.nan, math.inf, -math.inf])
def test_what_is_no_number_is_refused_with_the_old_value(bench: Bench, value: float) -> None:
    before = bench.vehicle.fleet.tobytes()
    answers = write(bench, "MAV_GCS_SYSID", value)
    assert bench.vehicle.fleet.tobytes() == before
    assert [m.param_value for m in answers if m.get_type() == "PARAM_VALUE"] == [255.0]
    assert any("MAV_GCS_SYSID" in m.text for m in answers if m.get_type() == "STATUSTEXT")


def test_what_has_no_effect_is_kept_and_told_once(bench: Bench) -> None:
    before = bench.vehicle.fleet.tobytes()
    answers = write(bench, "FRSKY_OPTIONS", 3.7)
    assert [m.param_value for m in answers if m.get_type() == "PARAM_VALUE"] == [3.0], "it is an integer"
    assert [m.text for m in answers if m.get_type() == "STATUSTEXT"] == [
        "FRSKY_OPTIONS has no effect in this simulator"
    ]
    (answer,) = write(bench, "FRSKY_OPTIONS", 5.0)
    assert (answer.param_value, answer.param_type) == (5.0, 2)
    assert [m.param_value for m in read(bench, "FRSKY_OPTIONS")] == [5.0]
    assert bench.vehicle.fleet.tobytes() == before


def test_a_client_that_sets_many_without_effect_is_not_flooded(bench: Bench) -> None:
    said = []
    for name in [p.name for p in TABLE if not (p.has_effect or p.doc)][:15]:
        said += [m.text for m in write(bench, name, 1.0) if m.get_type() == "STATUSTEXT"]
    assert len(said) == 11 and said[-1] == "Others that are set have no effect either"


def test_a_group_is_in_the_list_while_it_is_switched_on(bench: Bench) -> None:
    count = len(names(bench))
    (answer,) = read(bench, "BATT2_CAPACITY")
    assert (answer.param_value, answer.param_count) == (3300.0, count) and "BATT2_CAPACITY" not in names(bench)
    answer = write(bench, "BATT2_MONITOR", 3.0)[-1]
    assert answer.param_count == len(names(bench)) > count and "BATT2_CAPACITY" in names(bench)
    assert [m.param_id for m in read(bench, index=names(bench).index("BATT2_CAPACITY"))] == ["BATT2_CAPACITY"]


def test_a_new_system_id_holds_at_once(bench: Bench) -> None:
    write(bench, "MAV_SYSID", 7.0)
    assert read(bench, "MAV_SYSID") == []
    answers = bench.ask(mavlink.MAVLink_param_request_read_message(7, 1, b"MAV_SYSID", -1))
    assert [(m.get_srcSystem(), m.param_value) for m in answers] == [(7, 7.0)]


def fetch_all(bench: Bench, client: Client) -> dict[str, float]:
    """As ground stations do: the list, then what is missing, one by one."""
    found: dict[int, tuple[str, float]] = {}
    count = None
    for _ in range(50):
        if count is None or not found:
            client.send(mavlink.MAVLink_param_request_list_message(1, 1))
        else:
            for k in [k for k in range(count) if k not in found]:
                client.send(mavlink.MAVLink_param_request_read_message(1, 1, b"", k))
        bench.run(1.0)
        for m in client.receive("PARAM_VALUE"):
            count = m.param_count
            found[m.param_index] = (m.param_id, m.param_value)
        if count is not None and len(found) == count:
            return dict(found.values())
    raise AssertionError(f"{len(found)} of {count}")


@pytest.mark.parametrize("drop", [0.0, 0.05, 0.3])
def test_the_whole_list_even_over_a_lossy_link(bench: Bench, drop: float) -> None:
    rng = random.Random(1)
    client = bench.connect(drop_to_client=lambda _: rng.random() < drop, drop_to_vehicle=lambda _: rng.random() < drop)
    values = fetch_all(bench, client)
    assert values.keys() == set(names(bench)) < set(TABLE.names())
    for name, value in values.items():
        assert value == pytest.approx(bench.vehicle.parameters[name], rel=1e-6)


def test_the_list_is_paced(bench: Bench) -> None:
    """Ten in ten milliseconds, and it goes on after a restore."""
    bench.run(0.0025)
    bench.client.send(mavlink.MAVLink_param_request_list_message(1, 1))

    def came(seconds: float) -> list[int]:
        bench.run(seconds)
        return [m.param_index for m in bench.client.receive("PARAM_VALUE")]

    assert came(0.0025) == list(range(10)) and came(0.0075) == []
    held = bench.bridge.snapshot()
    for _ in range(2):
        assert came(0.0025) == list(range(10, 20)) and came(0.0075) == []
        bench.bridge.restore(held)
    end = len(names(bench))
    assert came(0.01 * end) == list(range(10, end)) and came(1.0) == []


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
    bench.vehicle.parameters["FRSKY_OPTIONS"] = 3.0
    bench.vehicle.parameters.defaults = {"WPNAV_SPEED": 450.0}  # of a file
    decoded = MAVFTP.ftp_param_decode(fetch(bench, b"@PARAM/param.pck" + query))
    values = {name.decode(): value for name, value, _ in decoded.params}
    assert list(values) == names(bench)
    for name, value in values.items():
        assert value == pytest.approx(bench.vehicle.parameters[name], rel=1e-6)
    assert values["FRSKY_OPTIONS"] == 3.0
    if query:
        defaults = {name.decode(): value for name, value, _ in decoded.defaults}
        assert defaults["MAV_GCS_SYSID"] == 255.0 and values["MAV_GCS_SYSID"] == 250.0
        assert defaults["WPNAV_SPEED"] == 450.0 != values["WPNAV_SPEED"]


def test_ground_stations_read_what_parameters_mean(bench: Bench) -> None:
    """COMPONENT_METADATA leads to a general file, and that one to the parameters' file."""
    bench.client.send(mavlink.MAVLink_command_long_message(1, 1, 512, 0, 397, 0, 0, 0, 0, 0, 0))
    bench.bridge.receive()
    frames = [f for f in Splitter().feed(bench.client.link.receive()) if f.kind.name == "COMPONENT_METADATA"]
    said = frames[0].kind.decode(frames[0].payload)
    assert said.uri.startswith(b"mftp://")
    general = fetch(bench, said.uri.removeprefix(b"mftp://"))
    assert said.file_crc == crc(general)
    assert json.loads(general)["version"] == 1
    (entry,) = json.loads(general)["metadataTypes"]
    assert entry["type"] == 1
    data = fetch(bench, entry["uri"].removeprefix("mftp://").encode())
    assert entry["fileCrc"] == file_crc(data)
    assert json.loads(data)["version"] == 1
    told = {p["name"]: p for p in json.loads(data)["parameters"]}
    assert list(told) == list(TABLE.names())
    assert told["ANGLE_MAX"] == {
        "name": "ANGLE_MAX", "type": "Int16", "group": "ANGLE", "category": "Standard", "default": 3000,
        "shortDesc": "Greatest lean in all modes", "units": "cdeg", "min": 500, "max": 8000,
    }  # fmt: skip
    assert told["FRSKY_OPTIONS"]["category"] == "Without effect" and "min" not in told["FRSKY_OPTIONS"]
    assert told["MIS_TOTAL"]["volatile"] and told["ATC_RAT_RLL_P"]["default"] == 0.135


def crc(data: bytes) -> int:
    """CRC-32 (polynomial 0xEDB88320, begins with 0, nothing inverted), bit by bit as MAVLink FTP's."""
    value = 0
    for byte in data:
        value ^= byte
        for _ in range(8):
            value = value >> 1 ^ (0xEDB88320 if value & 1 else 0)
    return value


def test_names_share_what_they_have_in_common_with_the_one_before() -> None:
    """At most all letters but the last, and at most fifteen."""
    names = ("ABCD", "ABC", "ABCE", "XBCE", "A23456789012345", "A234567890123456", "A234567890123457")
    values = [(TABLE["ANGLE_MAX"]._replace(name=name), 1000.0 + k, 1000.0) for k, name in enumerate(names)]
    for with_defaults in (False, True):
        decoded = MAVFTP.ftp_param_decode(pack_parameters(values, with_defaults))
        assert [(name.decode(), value) for name, value, _ in decoded.params] == [(p.name, v) for p, v, _ in values]
    shared = [0, 2, 3, 0, 0, 15, 15]
    sizes = [2 + len(name) - n + 2 for name, n in zip(names, shared, strict=True)]
    assert len(pack_parameters(values, False)) == 6 + sum(sizes)
    assert len(pack_parameters(values, True)) == 6 + sum(sizes) + 2 * 6, "the first has its default"


def test_read_in_pieces(bench: Bench) -> None:
    whole = fetch(bench, b"@PARAM/param.pck")
    (answer,) = bench.ask(request(READ, offset=100, size=50))
    assert unpack(answer)[1] == whole[100:150]
    (answer,) = bench.ask(request(READ, offset=len(whole), size=50))
    assert unpack(answer) == ((6, 0, NAK, 1, READ, 0, 0, 0), b"\x06")


@pytest.mark.parametrize(("message", "error"), [
    (request(OPEN, b"@SYS/threads.txt"), 10), (request(OPEN, b"\xff\xfe"), 10), (request(LIST, b"dir"), 10),
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


def values_of(answers: list[object]) -> dict[str, float]:
    return {m.param_id: m.param_value for m in answers if m.get_type() == "PARAM_VALUE"}


@pytest.mark.parametrize(
    ("name", "value", "own", "kept"),
    (
        ("PSC_NE_POS_P", -1.0, "PSC_POSXY_P", -1.0),
        ("PSC_D_VEL_P", 4.0, "PSC_VELZ_P", 4.0),
        ("PSC_JERK_D", 3.0, "PSC_JERK_Z", 3.0),
        ("EK3_FLOW_MAX", 2.0, "EK3_MAX_FLOW", 2.0),
        ("PSC_NE_VEL_IMAX", 5.0, "PSC_VELXY_IMAX", 500.0),
        ("ARMING_SKIPCHK", -1.0, "ARMING_CHECK", 0.0),
        ("ARMING_SKIPCHK", 0.0, "ARMING_CHECK", 1.0),
        ("ARMING_SKIPCHK", 64.0, "ARMING_CHECK", float((1 << 21) - 2 - 64)),
    ),
)
def test_names_of_the_development_version_are_read_and_set(
    bench: Bench, name: str, value: float, own: str, kept: float
) -> None:
    assert name not in names(bench)
    answers = values_of(write(bench, name, value))
    assert answers == {name: value, own: kept}
    assert bench.vehicle.parameters[own] == kept
    (answer,) = read(bench, name)
    assert (answer.param_id, answer.param_value, answer.param_index) == (name, value, 65535)
    assert answer.param_count == len(names(bench)) and answer.param_type == read(bench, own)[0].param_type


def test_other_names_of_other_versions_are_not_there(bench: Bench) -> None:
    for name in ("SYSID_MYGCS", "WP_SPD", "PSC_NE_NO_P", "PSC_NE_POS_PP"):
        assert values_of([*read(bench, name), *write(bench, name, 3.0)]) == {}


@pytest.mark.parametrize(
    ("ask", "told"),
    (
        (lambda b: read(b, "BOB"), ("BOB", -1, 1)),
        (lambda b: read(b, index=32764), ("", 32764, 1)),
        (lambda b: write(b, "BOB", 1.0), ("BOB", -1, 1)),
        (lambda b: write(b, "SPRAY_ENABLE", math.nan), ("SPRAY_ENABLE", -1, 2)),
        (lambda b: write(b, "PSC_NE_POS_P", math.inf), ("PSC_NE_POS_P", -1, 2)),
        (lambda b: write(b, "MIS_TOTAL", 7.0), ("MIS_TOTAL", -1, 3)),
        (lambda b: write(b, "LAND_SPEED", 60.0), None),
    ),
)
def test_who_asks_for_what_is_not_there_is_told_so(bench: Bench, ask: Any, told: Any) -> None:
    found = [m for m in ask(bench) if m.get_type() == "PARAM_ERROR"]
    assert [(m.param_id, m.param_index, m.error) for m in found] == ([told] if told else [])
    assert all((m.target_system, m.target_component) == (255, 190) for m in found)
