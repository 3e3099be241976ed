# SPDX-License-Identifier: BSD-3-Clause
"""The mission protocol: complete uploads replace, everything else leaves the old mission."""

from __future__ import annotations

import math
import random
from collections.abc import Callable
from typing import Any

import pytest
from pymavlink.dialects.v20 import ardupilotmega as mavlink

from sitl.autopilot.mission.item import MissionItem
from sitl.bridge import dialect
from sitl.bridge.services.mission_protocol import MissionService
from sitl.bridge.services.mission_upload import from_float
from tests.bridge.fakes import HOME, Bench, Client

ACCEPTED, ERROR, UNSUPPORTED_FRAME, UNSUPPORTED, NO_SPACE = range(5)
INVALID_PARAM1, INVALID_X, INVALID_SEQUENCE, DENIED, CANCELLED = 6, 10, 13, 14, 15
SQUARE = [
    MissionItem(16, 0, x=HOME[0], y=HOME[1], z=584.0),
    MissionItem(22, 3, z=10.0),
    *(MissionItem(16, 3, p1=k, x=HOME[0] + 2700 * k, y=HOME[1], z=10.0) for k in range(1, 5)),
    MissionItem(177, 0, p1=2, p2=1),
    MissionItem(21, 3, p4=1),
]


def item_int(seq: int, i: MissionItem, current: int = 0, kind: int = 0) -> Any:
    return mavlink.MAVLink_mission_item_int_message(
        1, 1, seq, i.frame, i.command, current, 1, i.p1, i.p2, i.p3, i.p4, i.x, i.y, i.z, kind
    )


def item_float(seq: int, i: MissionItem, current: int = 0) -> Any:
    scale = 1.0 if i.command == 177 else 1e-7
    return mavlink.MAVLink_mission_item_message(
        1, 1, seq, i.frame, i.command, current, 1, i.p1, i.p2, i.p3, i.p4, i.x * scale, i.y * scale, i.z
    )


def count(n: int, kind: int = 0) -> Any:
    return mavlink.MAVLink_mission_count_message(1, 1, n, kind)


OF_A_LIST: dict[str, Callable[[int], Any]] = {
    "count": lambda kind: count(2, kind),
    "no item": lambda kind: count(0, kind),
    "partial list": lambda kind: mavlink.MAVLink_mission_write_partial_list_message(1, 1, 1, 2, kind),
    "item": lambda kind: item_int(0, SQUARE[0], kind=kind),
    "item of a target": lambda kind: item_int(0, SQUARE[0], 2, kind),
    "item in degrees": lambda kind: mavlink.MAVLink_mission_item_message(
        1, 1, 0, 3, 16, 0, 1, 0, 0, 0, 0, -35.0, 149.0, 10.0, kind
    ),
    "request of the list": lambda kind: mavlink.MAVLink_mission_request_list_message(1, 1, kind),
    "request of an item": lambda kind: mavlink.MAVLink_mission_request_int_message(1, 1, 0, kind),
    "request of an item in degrees": lambda kind: mavlink.MAVLink_mission_request_message(1, 1, 0, kind),
    "clear": lambda kind: mavlink.MAVLink_mission_clear_all_message(1, 1, kind),
}
"""What a client can send of the list of a MAV_MISSION_TYPE."""


def upload(bench: Bench, client: Client, items: list[MissionItem], pack: Any = item_int) -> int:
    """As MAVSDK does: answer each request, repeat after half a second without one."""
    client.send(count(len(items)))
    last = count(len(items))
    for _ in range(400):
        bench.run(0.1)
        answers = client.receive("MISSION_REQUEST", "MISSION_ACK")
        for m in answers:
            if m.get_type() == "MISSION_ACK":
                return int(m.type)
            last = pack(m.seq, items[m.seq])
            client.send(last)
        if not answers:
            client.send(last)
    raise AssertionError("no end")


def download(bench: Bench, client: Client) -> list[Any]:
    client.send(mavlink.MAVLink_mission_request_list_message(1, 1))
    bench.bridge.receive()
    (n,) = client.receive("MISSION_COUNT")
    items = []
    for seq in range(n.count):
        client.send(mavlink.MAVLink_mission_request_int_message(1, 1, seq))
        bench.bridge.receive()
        items += client.receive("MISSION_ITEM_INT")
    return items


@pytest.mark.parametrize("drop", [0.0, 0.05])
def test_upload_and_download(bench: Bench, drop: float) -> None:
    for trial in range(20 if drop else 1):
        rng = random.Random(trial)
        lossy = bench.connect(
            drop_to_client=lambda _: rng.random() < drop,  # noqa: B023
            drop_to_vehicle=lambda _: rng.random() < drop,  # noqa: B023
        )
        bench.autopilot.items = ()
        assert upload(bench, lossy, SQUARE) == ACCEPTED
        assert list(bench.autopilot.items) == SQUARE
    got = download(bench, bench.client)
    fields = [(m.seq, m.command, m.frame, m.param1, m.x, m.y, m.z) for m in got]
    assert fields == [(k, i.command, i.frame, i.p1, i.x, i.y, i.z) for k, i in enumerate(SQUARE)]


def test_the_vehicle_asks_with_mission_request(bench: Bench) -> None:
    answers = bench.ask(count(2))
    assert [(m.get_type(), m.seq, m.target_system, m.target_component) for m in answers] == [
        ("MISSION_REQUEST", 0, 255, 190)
    ]
    answers = bench.ask(item_int(0, SQUARE[0]))
    assert [m.seq for m in answers] == [1]
    answers = bench.ask(item_int(1, SQUARE[1]))
    assert [m.text for m in answers if m.get_type() == "STATUSTEXT"] == ["Flight plan received"]


def test_legacy_float_items(bench: Bench) -> None:
    assert upload(bench, bench.client, SQUARE, item_float) == ACCEPTED
    for ours, sent in zip(bench.autopilot.items, SQUARE, strict=True):
        assert ours.x == pytest.approx(sent.x, abs=64) and ours.y == pytest.approx(sent.y, abs=64)
        assert (ours.command, ours.p1, ours.p2, ours.z) == (sent.command, sent.p1, sent.p2, sent.z)
    bench.client.send(mavlink.MAVLink_mission_request_message(1, 1, 2))
    bench.bridge.receive()
    (item,) = bench.client.receive("MISSION_ITEM")
    assert item.x == pytest.approx(SQUARE[2].x * 1e-7, abs=1e-5)


def test_the_int_frames_mean_the_same(bench: Bench) -> None:
    assert upload(bench, bench.client, [SQUARE[0], SQUARE[2]._replace(frame=6)]) == ACCEPTED
    assert bench.autopilot.items[1].frame == 3


BAD = [
    (SQUARE[2]._replace(p1=math.nan), INVALID_PARAM1),
    (SQUARE[2]._replace(p3=math.inf), INVALID_PARAM1 + 2),
    (SQUARE[2]._replace(frame=8), UNSUPPORTED_FRAME),
    (SQUARE[2]._replace(command=31000), UNSUPPORTED),
    (SQUARE[2]._replace(x=910_000_000), INVALID_X),
    (SQUARE[2]._replace(z=math.nan), 12),
]


@pytest.mark.parametrize(("bad", "result"), BAD)
def test_a_bad_item_ends_the_upload_and_leaves_the_old_mission(bench: Bench, bad: MissionItem, result: int) -> None:
    old = tuple(SQUARE)
    bench.autopilot.items = old
    assert upload(bench, bench.client, [SQUARE[0], SQUARE[1], bad]) == result
    assert bench.autopilot.items is old and bench.bridge.next_due_us() < 10**7


def test_a_command_that_missions_do_not_take_is_named(bench: Bench) -> None:
    bench.ask(count(2))
    bench.ask(item_int(0, SQUARE[0]))
    text, ack = bench.ask(item_int(1, SQUARE[2]._replace(command=31000)), "STATUSTEXT", "MISSION_ACK")
    assert ack.type == UNSUPPORTED and text.text == "Mission: item 1 command 31000 not supported"


def test_a_wrong_number_ends_the_upload(bench: Bench) -> None:
    bench.autopilot.items = old = tuple(SQUARE)
    bench.ask(count(4))
    bench.ask(item_int(0, SQUARE[0]))
    (ack,) = bench.ask(item_int(3, SQUARE[1]), "MISSION_ACK")
    assert ack.type == INVALID_SEQUENCE and bench.autopilot.items is old
    (ack,) = bench.ask(item_int(1, SQUARE[1]), "MISSION_ACK")
    assert ack.type == ERROR


def test_a_repeated_item_is_asked_past(bench: Bench) -> None:
    bench.ask(count(3))
    bench.ask(item_int(0, SQUARE[0]))
    assert not bench.ask(item_int(0, SQUARE[0]))  # a copy: to answer it would make more copies
    bench.run(0.25)
    bench.client.receive()
    (request,) = bench.ask(item_int(0, SQUARE[0]), "MISSION_REQUEST")
    assert request.seq == 1


def test_copies_that_come_late_do_no_harm(bench: Bench) -> None:
    bench.ask(count(4))
    for seq in range(3):
        assert [m.seq for m in bench.ask(item_int(seq, SQUARE[seq]))] == [seq + 1]
        assert not bench.ask(count(4)) and not bench.ask(item_int(0, SQUARE[0]))
    (ack,) = bench.ask(item_int(3, SQUARE[3]), "MISSION_ACK")
    assert ack.type == ACCEPTED and bench.autopilot.items == tuple(SQUARE[:4])
    (ack,) = bench.ask(item_int(1, SQUARE[1]), "MISSION_ACK")
    assert ack.type == ACCEPTED  # of what has been taken
    partial = mavlink.MAVLink_mission_write_partial_list_message(1, 1, 1, 2)
    bench.ask(partial)
    bench.ask(item_int(1, SQUARE[3]))
    assert not bench.ask(partial)
    (ack,) = bench.ask(item_int(2, SQUARE[3]), "MISSION_ACK")
    assert ack.type == ACCEPTED and bench.autopilot.items == (SQUARE[0], SQUARE[3], SQUARE[3], SQUARE[3])


def test_a_client_may_begin_its_upload_anew(bench: Bench) -> None:
    bench.ask(count(4))
    bench.ask(item_int(0, SQUARE[0]))
    bench.run(3.0)
    bench.client.receive()
    (request,) = bench.ask(count(4))
    assert request.seq == 0


def test_the_last_acknowledgement_is_repeated(bench: Bench) -> None:
    assert upload(bench, bench.client, SQUARE[:2]) == ACCEPTED
    (ack,) = bench.ask(item_int(1, SQUARE[1]), "MISSION_ACK")
    assert ack.type == ACCEPTED


def test_time_out_after_8_simulated_seconds(bench: Bench) -> None:
    bench.autopilot.items = old = tuple(SQUARE)
    bench.ask(count(3))
    bench.run(7.9)
    assert not bench.client.receive("MISSION_ACK")
    bench.run(0.2)
    (ack,) = bench.client.receive("MISSION_ACK")
    assert ack.type == CANCELLED and bench.autopilot.items is old
    bench.run(20.0)
    assert not bench.client.receive("MISSION_ACK", "MISSION_REQUEST")


def test_two_uploads_do_not_mix(bench: Bench) -> None:
    other = bench.connect(system=250)
    bench.ask(count(2))
    for message in (count(3), item_int(0, SQUARE[3]), mavlink.MAVLink_mission_clear_all_message(1, 1)):
        other.send(message)
        bench.bridge.receive()
        (ack,) = other.receive("MISSION_ACK")
        assert ack.type == DENIED
    bench.ask(item_int(0, SQUARE[0]))
    bench.ask(item_int(1, SQUARE[1]))
    assert bench.autopilot.items == (SQUARE[0], SQUARE[1])


def test_partial_write(bench: Bench) -> None:
    bench.autopilot.items = tuple(SQUARE)
    new = SQUARE[3]._replace(z=33.0)
    answers = bench.ask(mavlink.MAVLink_mission_write_partial_list_message(1, 1, 3, 3))
    assert [m.seq for m in answers] == [3]
    (ack,) = bench.ask(item_int(3, new), "MISSION_ACK")
    assert ack.type == ACCEPTED
    assert bench.autopilot.items == (*SQUARE[:3], new, *SQUARE[4:])
    for first, last in ((3, 2), (0, 99), (-1, 2)):
        text, ack = bench.ask(
            mavlink.MAVLink_mission_write_partial_list_message(1, 1, first, last), "STATUSTEXT", "MISSION_ACK"
        )
        assert ack.type == ERROR and text.text == "Flight plan update rejected"


def test_partial_write_adds_an_item(bench: Bench) -> None:
    bench.autopilot.items = tuple(SQUARE)
    end = len(SQUARE)
    bench.ask(mavlink.MAVLink_mission_write_partial_list_message(1, 1, end, end))
    (ack,) = bench.ask(item_int(end, SQUARE[3]), "MISSION_ACK")
    assert ack.type == ACCEPTED
    assert bench.autopilot.items == (*SQUARE, SQUARE[3])


def test_clear_and_empty_upload(bench: Bench) -> None:
    for message in (mavlink.MAVLink_mission_clear_all_message(1, 1), count(0),
                    mavlink.MAVLink_mission_clear_all_message(1, 1, 255)):  # fmt: skip
        bench.autopilot.items = tuple(SQUARE)
        (ack,) = bench.ask(message, "MISSION_ACK")
        assert ack.type == ACCEPTED and bench.autopilot.items == ()


def test_too_many(bench: Bench) -> None:
    text, ack = bench.ask(count(60000), "STATUSTEXT", "MISSION_ACK")
    assert ack.type == NO_SPACE and text.text == "Only 724 items are supported"


@pytest.mark.parametrize(
    ("kind", "command", "p1", "total", "counted"),
    [(1, 5003, 50.0, "FENCE_TOTAL", 0), (1, 5001, 3.0, "FENCE_TOTAL", 5), (2, 5100, 0.0, "RALLY_TOTAL", 3)],
)
def test_fence_and_rally_points_are_kept(
    bench: Bench, kind: int, command: int, p1: float, total: str, counted: int
) -> None:
    bench.autopilot.items = old = tuple(SQUARE)
    points = [MissionItem(command, 3, p1=p1, x=HOME[0] + k, y=HOME[1], z=20.0) for k in range(3)]

    def listed() -> int:
        (n,) = bench.ask(mavlink.MAVLink_mission_request_list_message(1, 1, kind))
        assert (n.get_type(), n.mission_type) == ("MISSION_COUNT", kind)
        return int(n.count)

    def put() -> None:
        requests = bench.ask(count(3, kind))
        for k, point in enumerate(points):
            assert [(m.get_type(), m.seq, m.mission_type) for m in requests] == [("MISSION_REQUEST", k, kind)]
            requests = bench.ask(item_int(k, point, kind=kind), "MISSION_REQUEST", "MISSION_ACK")
        assert [(m.get_type(), m.type, m.mission_type) for m in requests] == [("MISSION_ACK", ACCEPTED, kind)]
        assert (listed(), bench.vehicle.parameters[total]) == (3, counted)

    assert listed() == 0
    for clear in (count(0, kind), *(mavlink.MAVLink_mission_clear_all_message(1, 1, k) for k in (kind, 255))):
        put()
        (got,) = bench.ask(mavlink.MAVLink_mission_request_int_message(1, 1, 2, kind))
        assert (got.command, got.x, got.param1, got.mission_type, got.current) == (command, HOME[0] + 2, p1, kind, 0)
        assert bench.autopilot.items is old
        (ack,) = bench.ask(clear, "MISSION_ACK")
        assert ack.type == ACCEPTED and listed() == bench.vehicle.parameters[total] == 0


def test_room_for_fences_and_rally_points(bench: Bench) -> None:
    """ArduPilot's storage; BRD_SD_FENCE gives more."""
    for kind, most in ((1, 70), (2, 46)):
        text, ack = bench.ask(count(most + 1, kind), "STATUSTEXT", "MISSION_ACK")
        assert ack.type == NO_SPACE and text.text == f"Only {most} items are supported"

    def circles(number: int) -> list[Any]:
        bench.ask(count(number, 1))
        for k in range(number):
            got = bench.ask(item_int(k, MissionItem(5004, 0, p1=5.0, x=k), kind=1), "STATUSTEXT", "MISSION_ACK")
        return [m.text if m.get_type() == "STATUSTEXT" else m.type for m in got]

    full = "Fence exceeds storage size"
    assert ACCEPTED in circles(42)
    assert {full, 1} <= set(circles(43))
    assert len(bench.bridge.get(MissionService).items(1)) == 42, "what was there stays"
    bench.vehicle.parameters["BRD_SD_FENCE"] = 128.0
    assert ACCEPTED in circles(56)
    assert {full, 1} <= set(circles(57))


def test_items_that_make_no_fence_are_refused(bench: Bench) -> None:
    bench.ask(count(2, 1))
    bench.ask(item_int(0, MissionItem(5001, 0, p1=2.0), kind=1))
    got = bench.ask(item_int(1, MissionItem(5001, 0, p1=2.0), kind=1), "STATUSTEXT", "MISSION_ACK")
    assert [m.text for m in got if m.get_type() == "STATUSTEXT"] == [
        "Invalid vertex count (2)",
        "Fence validation failed",
    ]
    assert [m.type for m in got if m.get_type() == "MISSION_ACK"] == [1]
    assert bench.bridge.get(MissionService).items(1) == ()


def test_lists_take_only_their_items(bench: Bench) -> None:
    for kind, command in ((0, 5003), (1, 16), (1, 5100), (2, 5001)):
        bench.ask(count(2, kind))
        (ack,) = bench.ask(item_int(0, MissionItem(command, 3, x=HOME[0], y=HOME[1]), kind=kind), "MISSION_ACK")
        assert (ack.type, ack.mission_type) == (UNSUPPORTED, kind)
    for kind in (3, 255):
        (ack,) = bench.ask(count(2, kind), "MISSION_ACK")
        assert ack.type == UNSUPPORTED


def test_fences_outlive_a_reboot_and_a_restore(bench: Bench) -> None:
    bench.ask(count(1, 1))
    bench.ask(item_int(0, MissionItem(5003, 3, p1=50.0, x=HOME[0], y=HOME[1]), kind=1))
    kept = bench.bridge.snapshot()
    bench.bridge = bench.bridge.successor()
    ask = mavlink.MAVLink_mission_request_list_message(1, 1, 1)
    assert bench.ask(ask, "MISSION_COUNT")[0].count == 1
    bench.ask(count(0, 1))
    bench.bridge.restore(kept)
    assert bench.ask(ask, "MISSION_COUNT")[0].count == 1


def test_a_partial_write_waits_for_the_upload_under_way(bench: Bench) -> None:
    bench.ask(count(10, 1))
    (ack,) = bench.ask(mavlink.MAVLink_mission_write_partial_list_message(1, 1, 3, 3, 1), "MISSION_ACK")
    assert ack.type == DENIED
    bench.run(8.1)
    (ack,) = bench.client.receive("MISSION_ACK")
    assert (ack.type, ack.mission_type) == (CANCELLED, 1)


def test_who_uploads_can_clear_instead(bench: Bench) -> None:
    bench.ask(count(3))
    (ack,) = bench.ask(mavlink.MAVLink_mission_clear_all_message(1, 1), "MISSION_ACK")
    assert ack.type == ACCEPTED
    bench.run(10.0)
    assert not bench.client.receive("MISSION_ACK", "MISSION_REQUEST")


def test_set_current(bench: Bench) -> None:
    bench.autopilot.items = tuple(SQUARE)
    answers = bench.ask(mavlink.MAVLink_mission_set_current_message(1, 1, 3), "MISSION_CURRENT")
    assert answers[0].seq == 3
    assert bench.ask(mavlink.MAVLink_mission_set_current_message(1, 1, 99)) == []
    answers = bench.ask(mavlink.MAVLink_mission_request_int_message(1, 1, 3))
    assert answers[0].current == 0  # as of ArduPilot, which compares the number of the command
    for kind, size in ((0, len(SQUARE)), (1, 0), (2, 0)):
        size_told, ack = bench.ask(mavlink.MAVLink_mission_request_int_message(1, 1, 99, kind))
        assert (size_told.get_type(), size_told.count, size_told.mission_type) == ("MISSION_COUNT", size, kind)
        assert (ack.type, ack.mission_type) == (INVALID_SEQUENCE, kind)


def test_a_client_that_leaves_frees_the_upload(bench: Bench) -> None:
    other = bench.connect(system=250)
    other.send(count(3))
    bench.bridge.receive()
    bench.bridge.remove_link(other.link)
    assert [m.get_type() for m in bench.ask(count(2))] == ["MISSION_REQUEST"]


def test_dronekit_goto(bench: Bench) -> None:
    bench.vehicle.locate()
    goto = item_float(0, MissionItem(16, 3, x=HOME[0] + 1000, y=HOME[1], z=7.0), current=2)
    (ack,) = bench.ask(goto, "MISSION_ACK")
    assert ack.type == ERROR  # not in GUIDED
    bench.vehicle.v.autopilot.modes.number = 4
    (ack,) = bench.ask(goto, "MISSION_ACK")
    assert ack.type == ACCEPTED
    name, place = bench.autopilot.calls[-1]
    assert name == "guided_position" and place == pytest.approx((11.1, 0.0, -7.0), abs=0.7)


def test_home_of_an_empty_mission(bench: Bench) -> None:
    """DroneKit asks for item 0 of a mission of no items, and waits for it; ArduPilot gives home."""
    home = bench.vehicle.v.autopilot.home
    home.lat, home.lon, home.alt, home.is_set = -353632620, 1491652370, 584.0, 1
    (item,) = bench.ask(mavlink.MAVLink_mission_request_message(1, 1, 0), "MISSION_ITEM")
    assert (item.seq, item.command, item.z) == (0, 16, 584.0)
    assert item.x == pytest.approx(-35.363262) and item.y == pytest.approx(149.165237)
    (ack,) = bench.ask(mavlink.MAVLink_mission_request_message(1, 1, 1))
    assert ack.type == INVALID_SEQUENCE


@pytest.mark.parametrize("kind", [3, 254])
@pytest.mark.parametrize("name", sorted(OF_A_LIST))
def test_lists_that_there_are_not_are_refused_in_every_message(bench: Bench, name: str, kind: int) -> None:
    bench.autopilot.items = old = tuple(SQUARE)
    (ack,) = bench.ask(OF_A_LIST[name](kind), "MISSION_ACK")
    assert (ack.type, ack.mission_type) == (UNSUPPORTED, kind)
    assert (ack.target_system, ack.target_component) == (255, 190)
    bench.run(10.0)
    assert bench.autopilot.items is old and bench.client.receive("MISSION_ACK", "MISSION_REQUEST") == []


@pytest.mark.parametrize(
    ("x", "y", "result"),
    [
        (90.0, 180.0, 0), (-90.0, -180.0, 0), (90.00001, 0.0, 10), (-90.00001, 0.0, 10), (math.nan, 0.0, 10),
        (math.inf, 0.0, 10), (0.0, 180.00002, 11), (0.0, -180.00002, 11), (0.0, math.nan, 11), (0.0, -math.inf, 11),
    ],
)  # fmt: skip
def test_degrees_are_on_the_globe_up_to_the_poles(x: float, y: float, result: int) -> None:
    """MAV_MISSION_INVALID_PARAM5_X and _PARAM6_Y."""
    kind = dialect.message("MISSION_ITEM")
    fields = kind.decode(kind.payload(command=16, frame=3, x=x, y=y, z=10.0))
    item, found = from_float(fields, {16})
    assert found == result
    if result == 0:
        assert (item.x, item.y) == (round(1e7 * x), round(1e7 * y))


def texts(answers: list[Any]) -> list[tuple[int, str]]:
    return [(m.severity, m.text) for m in answers if m.get_type() == "STATUSTEXT"]


def kinds(answers: list[Any]) -> list[str]:
    return [m.get_type() for m in answers if m.get_type().startswith("MISSION")]


def later(bench: Bench, seconds: float) -> list[Any]:
    """What comes while time passes."""
    bench.run(seconds)
    return bench.client.receive("MISSION_REQUEST", "MISSION_ACK", "STATUSTEXT")


def test_an_item_is_asked_for_each_second_for_8_seconds(bench: Bench) -> None:
    bench.run(3.0)
    bench.ask(count(3))
    assert later(bench, 0.9975) == []
    assert kinds(later(bench, 0.0025)) == ["MISSION_REQUEST"]
    bench.ask(item_int(0, SQUARE[0]))
    assert kinds(later(bench, 7.9975)) == 7 * ["MISSION_REQUEST"]
    answers = later(bench, 0.0025)
    assert kinds(answers) == ["MISSION_ACK"] and texts(answers) == [(4, "Mission upload timeout")]


@pytest.mark.parametrize(("seconds", "asks"), [(0.1975, False), (0.2, True)])
def test_an_item_that_is_there_is_answered_after_a_fifth_of_a_second(bench: Bench, seconds: float, asks: bool) -> None:
    bench.ask(count(3))
    bench.ask(item_int(0, SQUARE[0]))
    bench.run(seconds)
    assert kinds(bench.ask(item_int(0, SQUARE[0]))) == asks * ["MISSION_REQUEST"]


@pytest.mark.parametrize(("seconds", "is_copy"), [(1.9975, True), (2.0, False)])
def test_copies_come_within_two_seconds(bench: Bench, seconds: float, is_copy: bool) -> None:
    bench.ask(count(3))
    bench.ask(item_int(0, SQUARE[0]))
    later(bench, seconds)
    assert [m.seq for m in bench.ask(count(3), "MISSION_REQUEST")] == ([] if is_copy else [0])
    for seq in range(is_copy, 3):
        (answer,) = bench.ask(item_int(seq, SQUARE[seq]), "MISSION_REQUEST", "MISSION_ACK")
    assert answer.type == ACCEPTED
    later(bench, seconds)
    for seq, result in ((0, ACCEPTED if is_copy else ERROR), (2, ACCEPTED), (3, ERROR)):
        (ack,) = bench.ask(item_int(seq, SQUARE[seq]), "MISSION_ACK")
        assert ack.type == result, seq


def test_a_count_that_comes_twice_at_once_is_asked_for_twice(bench: Bench) -> None:
    assert [len(bench.ask(count(n), "MISSION_REQUEST")) for n in (3, 3, 4, 3)] == [1, 1, 1, 1]


@pytest.mark.parametrize(
    ("system", "result", "ends"), [(255, ERROR, True), (255, ACCEPTED, False), (250, ERROR, False)]
)
def test_who_uploads_can_give_up(bench: Bench, system: int, result: int, ends: bool) -> None:
    other = bench.connect(system=250)
    bench.ask(count(3))
    client = bench.client if system == 255 else other
    client.send(mavlink.MAVLink_mission_ack_message(1, 1, result))
    bench.bridge.receive()
    assert kinds(later(bench, 1.0)) == (not ends) * ["MISSION_REQUEST"]
    other.receive()
    other.send(mavlink.MAVLink_mission_request_list_message(1, 1))
    bench.bridge.receive()
    assert kinds(other.receive()) == ["MISSION_COUNT" if ends else "MISSION_ACK"]


@pytest.mark.parametrize(
    ("kind", "said"), [(0, [(6, "Flight plan received")]), (1, [(7, "Fence Indexed OK")]), (2, [])]
)
def test_a_list_that_was_taken_is_said(bench: Bench, kind: int, said: Any) -> None:
    """Of an empty one, only a mission's."""
    bench.ask(count(1, kind))
    item = (SQUARE[0], MissionItem(5003, 3, p1=50.0, x=HOME[0], y=HOME[1]), MissionItem(5100, 3, x=HOME[0], y=HOME[1]))
    assert texts(bench.ask(item_int(0, item[kind], kind=kind))) == said
    assert texts(bench.ask(count(0, kind))) == (said if kind == 0 else [])


def test_old_messages_are_named(bench: Bench) -> None:
    """MISSION_ITEM once in an upload, MISSION_REQUEST once until the next upload."""
    use = [(4, "got MISSION_ITEM; GCS should send MISSION_ITEM_INT")]
    assert texts(bench.ask(item_float(0, SQUARE[0]))) == [], "no upload"
    bench.ask(count(3))
    assert texts(bench.ask(item_float(0, SQUARE[0], current=2))) == []
    assert [texts(bench.ask(item_float(k, SQUARE[k]))) for k in (0, 1)] == [use, []]
    ask = mavlink.MAVLink_mission_request_message(1, 1, 0)
    old = [(4, "got MISSION_REQUEST; use MISSION_REQUEST_INT!")]
    assert [texts(bench.ask(ask)) for _ in range(3)] == [old, [], []]
    bench.ask(count(4))
    assert [texts(bench.ask(ask)) for _ in range(2)] == [old, []]


@pytest.mark.parametrize(
    ("kind", "result", "fences"), [(0, ERROR, 1), (255, ERROR, 1), (1, ACCEPTED, 0), (2, ACCEPTED, 1)]
)
def test_a_mission_that_is_flown_is_not_cleared(bench: Bench, kind: int, result: int, fences: int) -> None:
    """Nor is anything else with it."""
    bench.ask(count(1, 1))
    bench.ask(item_int(0, MissionItem(5003, 3, p1=50.0, x=HOME[0], y=HOME[1]), kind=1))
    bench.autopilot.clear_mission = lambda: False  # type: ignore[method-assign]
    (ack,) = bench.ask(mavlink.MAVLink_mission_clear_all_message(1, 1, kind), "MISSION_ACK")
    assert (ack.type, ack.mission_type) == (result, kind)
    assert bench.ask(mavlink.MAVLink_mission_request_list_message(1, 1, 1), "MISSION_COUNT")[0].count == fences


def test_an_item_is_current_where_the_number_of_its_command_is(bench: Bench) -> None:
    bench.autopilot.items = tuple(SQUARE)
    bench.ask(count(1, 1))
    bench.ask(item_int(0, MissionItem(5003, 3, p1=50.0, x=HOME[0], y=HOME[1]), kind=1))
    nav = bench.vehicle.v.autopilot.modes.nav
    for current, seq, kind, told in ((16, 0, 0, 1), (16, 1, 0, 0), (22, 1, 0, 1), (5003, 0, 1, 0)):
        nav.mission_current = current
        (item,) = bench.ask(mavlink.MAVLink_mission_request_int_message(1, 1, seq, kind), "MISSION_ITEM_INT")
        assert item.current == told


def test_lists_can_be_taken_at_once(bench: Bench) -> None:
    kind = dialect.message("MISSION_ITEM_INT")
    good = kind.decode(kind.payload(command=16, frame=3, x=HOME[0], y=HOME[1], z=5.0))
    bad = kind.decode(kind.payload(command=5003, frame=3))
    service = bench.bridge.get(MissionService)
    bench.client.receive()
    for rows, ok in (([good, bad], False), (725 * [good], False), (724 * [good], True)):
        assert service.take(0, rows) == ok
        assert len(bench.autopilot.items) == 724 * ok
        assert texts(bench.ask(count(0, 99))) == ok * [(6, "Flight plan received")]
    bench.ask(count(3))
    assert not service.take(0, [good]) and len(bench.autopilot.items) == 724, "an upload is under way"


def test_lists_are_kept_and_counted(bench: Bench) -> None:
    corners = ((0, 0), (0, 9000), (9000, 0))
    fence = tuple(MissionItem(5001, 3, p1=3.0, x=HOME[0] + x, y=HOME[1] + y) for x, y in corners)
    rally = 2 * (MissionItem(5100, 3, x=HOME[0], y=HOME[1]),)
    service, values = bench.bridge.get(MissionService), bench.vehicle.parameters
    service.keep(fence, rally)
    assert (values["FENCE_TOTAL"], values["RALLY_TOTAL"]) == (0.0, 0.0) and service.lists == (fence, rally)
    service.keep(fence, rally, counted=True)
    assert (values["FENCE_TOTAL"], values["RALLY_TOTAL"]) == (5.0, 2.0)
