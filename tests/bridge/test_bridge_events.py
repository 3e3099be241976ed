# SPDX-License-Identifier: BSD-3-Clause
"""Events of the core on their way to clients, and what the bridge itself answers."""

from __future__ import annotations

import math
from types import SimpleNamespace
from typing import Any

import pytest
from pymavlink.dialects.v20 import ardupilotmega as mavlink

from sitl.autopilot import events
from sitl.autopilot.arming_checks import ARMED, DISARMED
from sitl.autopilot.estimation.estimator_events import EKF_ORIGIN_SET
from sitl.autopilot.events import EVENT_RING
from sitl.autopilot.fence.checks import FENCE_BREACHED
from sitl.autopilot.hits import HIT_GROUND
from sitl.autopilot.mission.item import MissionItem
from sitl.autopilot.mission.notes import OutputItem
from sitl.autopilot.modes import MODE_CHANGED
from sitl.autopilot.notes import ChecksFailed, CurrentChanged, ItemReached, ParametersFound, Switched, Text
from sitl.bridge.links import InProcessLink, LinkFaults
from sitl.bridge.locations import Locations
from sitl.bridge.services.home import HomeService
from sitl.bridge.services.statustext import StatusTextService
from sitl.core.constants import NEVER
from tests.bridge.fakes import HOME, Bench


def emit(bench: Bench, code: int, a: float = 0.0, b: float = 0.0) -> None:
    v = bench.vehicle.v
    events.emit(v.autopilot.events, int(v.time_us), code, a, b)


def texts(bench: Bench) -> list[str]:
    return [m.text for m in bench.client.receive("STATUSTEXT")]


def test_texts_of_a_flight(bench: Bench) -> None:
    bench.run(3.0)
    assert texts(bench) == ["Barometer 1 calibration complete", "ArduPilot Ready"]
    emit(bench, ARMED)
    emit(bench, HIT_GROUND, 0.499648)
    emit(bench, DISARMED)
    bench.run(0.1)
    assert texts(bench) == ["Arming motors", "SIM Hit ground at 0.499648 m/s", "Disarming motors"]
    bench.run(1.0)
    assert texts(bench) == []


def test_a_full_ring_loses_the_oldest_only(bench: Bench) -> None:
    bench.run(3.0)
    texts(bench)
    for _ in range(EVENT_RING + 10):
        emit(bench, ARMED)
    bench.run(0.1)
    assert len(texts(bench)) == EVENT_RING


def test_origin_and_home_are_told_when_they_come(bench: Bench) -> None:
    bench.vehicle.locate()
    emit(bench, EKF_ORIGIN_SET)
    bench.run(0.1)
    found = bench.client.receive()
    assert {"HOME_POSITION", "GPS_GLOBAL_ORIGIN"} <= {m.get_type() for m in found}
    assert "Field Elevation Set: 584m" in [m.text for m in found if m.get_type() == "STATUSTEXT"]


def test_a_mode_change_is_told_by_a_heartbeat_at_once(bench: Bench) -> None:
    bench.run(1.0)
    bench.client.receive()
    bench.vehicle.v.autopilot.modes.number = 6
    emit(bench, MODE_CHANGED, 6.0)
    bench.bridge.on_events()
    bench.bridge.flush()
    assert [m.custom_mode for m in bench.client.receive("HEARTBEAT")] == [6]


def test_progress_of_a_mission(bench: Bench) -> None:
    bench.bridge.report([ItemReached(3), Text(6, "Reached command #3"), CurrentChanged(4)])
    bench.bridge.flush()
    found = bench.client.receive()
    assert [m.get_type() for m in found] == ["MISSION_ITEM_REACHED", "STATUSTEXT", "MISSION_CURRENT"]
    assert found[0].seq == 3


def test_long_texts_come_in_pieces(bench: Bench) -> None:
    old = bench.connect(version=1)
    say = bench.bridge.get(StatusTextService).say
    for length in (1, 49, 50, 51, 100, 120):
        bench.bridge.channels[1].port.version = 1
        say(4, "x" * length)
        bench.bridge.flush()
        pieces = bench.client.receive("STATUSTEXT")
        assert "".join(p.text for p in pieces) == "x" * length
        assert [p.chunk_seq for p in pieces] == list(range(len(pieces)))
        assert (pieces[0].id != 0) == (length > 50)
        assert len(pieces[-1].text) < 50 or length == 50
        (first,) = old.receive("STATUSTEXT")
        assert first.text == "x" * min(length, 50)


def test_each_note_is_passed_on_to_whom_it_is_for(bench: Bench) -> None:
    bench.run(3.0)
    bench.client.receive()
    item = MissionItem(181, p1=1.0, p2=1.0)
    done: list[Any] = []
    bench.bridge.carry_out = done.append  # type: ignore[method-assign]
    bench.bridge.switched = lambda *what: done.append(what)  # type: ignore[method-assign]
    bench.bridge.keep_parameters = done.append  # type: ignore[method-assign]
    bench.bridge.autopilot.refusal_texts = lambda failed: [f"Arm: {failed}", "Arm: other"]  # type: ignore[method-assign]
    bench.bridge.report([OutputItem(item), Switched(9, 2), ParametersFound(("A", "B")), ChecksFailed(5), Text(6, "x")])
    assert done == [item, (9, 2), ("A", "B")]
    said = [(m.severity, m.text) for m in bench.client.receive("STATUSTEXT")]
    assert said == [(2, "Arm: 5"), (2, "Arm: other"), (6, "x")]


@pytest.mark.parametrize("is_sent", [True, False])
def test_an_item_that_only_logs_have_is_told_to_listeners_alone(bench: Bench, is_sent: bool) -> None:
    reached: list[int] = []
    bench.bridge.listeners = [SimpleNamespace(reached=reached.append)]  # type: ignore[assignment, list-item]
    bench.client.receive()
    bench.bridge.report([ItemReached(3, is_sent)])
    assert [m.seq for m in bench.client.receive("MISSION_ITEM_REACHED")] == ([3] if is_sent else [])
    assert reached == [3]


def test_parameters_that_the_firmware_has_found_are_kept(bench: Bench) -> None:
    bench.client.receive()
    bench.vehicle.v.autopilot.params["MOT_THST_HOVER"] = 0.25
    bench.bridge.keep_parameters(("MOT_THST_HOVER",))
    assert bench.vehicle.parameters["MOT_THST_HOVER"] == 0.25
    bench.run(0.1)
    assert [(m.param_id, m.param_value) for m in bench.client.receive("PARAM_VALUE")] == [("MOT_THST_HOVER", 0.25)]


def test_texts_of_booting_come_at_their_times_once_somebody_listens() -> None:
    bench = Bench()
    bench.run(0.0025)
    said = [(m.severity, m.text) for m in bench.client.receive("STATUSTEXT")]
    assert said == [(6, "Barometer 1 calibration complete")]
    bench.run(2.4450)
    assert texts(bench) == []
    bench.run(0.0025)
    assert texts(bench) == ["ArduPilot Ready"]
    bench = Bench()
    bench.bridge.remove_link(bench.client.link)
    bench.run(5.0)
    assert bench.bridge.shell_due_us() > 5_000_000
    bench.client = bench.connect()
    bench.run(0.0050)
    assert texts(bench) == ["Barometer 1 calibration complete", "ArduPilot Ready"]


def test_numbers_of_long_texts_begin_anew_with_1_and_other_letters_are_question_marks(bench: Bench) -> None:
    service = bench.bridge.get(StatusTextService)
    service._id = 65534
    for number in (65535, 1, 2):
        service.say(3, "é" + 50 * "x")
        bench.bridge.flush()
        pieces = bench.client.receive("STATUSTEXT")
        assert [(p.id, p.severity, p.text) for p in pieces] == [(number, 3, "?" + 49 * "x"), (number, 3, "x")]


def test_who_is_not_armed_is_checked_every_thirty_seconds(bench: Bench) -> None:
    def checked(seconds: float) -> int:
        bench.autopilot.calls.clear()
        bench.run(seconds)
        return bench.autopilot.calls.count(("run_prearm_checks",))

    assert checked(29.9975) == 0 and checked(0.0025) == 1 and checked(29.9975) == 0 and checked(0.0025) == 1
    bench.vehicle.v.autopilot.arming.armed = 1
    emit(bench, ARMED)
    assert checked(100.0) == 0 and bench.bridge.now_us == 160_000_000
    bench.vehicle.v.autopilot.arming.armed = 0
    emit(bench, DISARMED)
    assert checked(19.9975) == 0 and checked(0.0025) == 1


@pytest.mark.parametrize("name", ["home", "origin"])
@pytest.mark.parametrize(
    ("lat", "lon", "taken"),
    [
        (900_000_000, 1_800_000_000, True), (-900_000_000, -1_800_000_000, True), (900_000_001, 0, False),
        (-900_000_001, 0, False), (5, 1_800_000_001, False), (5, -1_800_000_001, False), (0, 0, False),
        (1, 0, True), (0, 1, True),
    ],
)  # fmt: skip
def test_homes_and_origins_are_on_the_globe(bench: Bench, name: str, lat: int, lon: int, taken: bool) -> None:
    if name == "home":
        bench.ask(mavlink.MAVLink_set_home_position_message(1, lat, lon, 584_000, 0, 0, 0, [1, 0, 0, 0], 0, 0, 0))
    else:
        bench.ask(mavlink.MAVLink_set_gps_global_origin_message(1, lat, lon, 584_000))
    assert bench.autopilot.calls == [(f"set_{name}", lat, lon, 584.0)] * taken


def test_a_home_that_is_set_after_the_origin_is_told(bench: Bench) -> None:
    """It is looked for every 50 ms until there is one."""
    bench.run(3.0)
    bench.vehicle.locate()
    home = bench.vehicle.v.autopilot.home
    home.is_set = 0
    emit(bench, EKF_ORIGIN_SET)
    bench.run(0.0025)
    assert [m.get_type() for m in bench.client.receive("HOME_POSITION", "GPS_GLOBAL_ORIGIN")] == ["GPS_GLOBAL_ORIGIN"]
    bench.run(0.0525)
    home.is_set = 1
    bench.run(0.0450)
    assert bench.client.receive("HOME_POSITION", "GPS_GLOBAL_ORIGIN") == []
    bench.run(0.0050)
    assert [m.get_type() for m in bench.client.receive("HOME_POSITION", "GPS_GLOBAL_ORIGIN")] == ["HOME_POSITION"]
    assert bench.bridge.get(HomeService).due_us == NEVER
    bench.run(10.0)
    assert bench.client.receive("HOME_POSITION", "GPS_GLOBAL_ORIGIN") == []


def test_a_breach_of_a_fence_is_told_at_once(bench: Bench) -> None:
    bench.run(3.0)
    bench.client.receive()
    fence = bench.vehicle.v.autopilot.fence
    fence.on, fence.breached = 1, 2
    emit(bench, FENCE_BREACHED)
    bench.bridge.on_events()
    assert [m.breach_type for m in bench.client.receive("FENCE_STATUS")] == [3]


# ---------------------------------------------------------------- the bridge itself


def test_parameters_as_the_bridge_reads_them(bench: Bench) -> None:
    bench.vehicle.parameters.update({"FRSKY_OPTIONS": 5.0, "WPNAV_SPEED": 437.0})
    assert [bench.bridge.parameter(name) for name in ("WPNAV_SPEED", "FRSKY_OPTIONS", "NONE")] == [437.0, 5.0, None]
    for value, system in ((-3.0, 1), (1.0, 1), (255.0, 255), (300.0, 255)):
        bench.vehicle.v.autopilot.params.MAV.SYSID = value
        assert bench.bridge.system == system


def test_simulations_begin_with_2026(bench: Bench) -> None:
    bench.run(2.5)
    (m,) = bench.telemetry("SYSTEM_TIME")
    assert (m.time_unix_usec, m.time_boot_ms) == (1_767_225_602_500_000, 2_500)


def test_streams_of_a_link_are_those_of_all_its_clients(bench: Bench) -> None:
    """Later ones, and after a reboot; those of other links have their own."""

    def rates() -> tuple[int, ...]:
        for client in clients:
            client.receive()
        bench.run(2.0)
        return tuple(len(client.receive("ATTITUDE")) for client in clients)

    clients = (bench.client, bench.connect())
    bench.bridge.stream_to(bench.client.link, {"EXTRA1": 10})
    assert rates() == (20, 0)
    with pytest.raises(KeyError):
        bench.bridge.stream_to(bench.client.link, {"EXTRA9": 10})
    bench.bridge.stream_to(bench.client.link, {"EXTRA1": 5})
    bench.bridge = bench.bridge.successor()
    assert rates() == (10, 0)


@pytest.mark.parametrize(
    ("waits", "watched", "by_itself"), [(True, False, True), (False, False, False), (True, True, False)]
)
def test_the_core_goes_on_alone_where_nobody_looks_at_each_frame(
    bench: Bench, waits: bool, watched: bool, by_itself: bool
) -> None:
    link = InProcessLink()
    peer = link.peers[0]
    peer.spools, peer.waits = True, waits  # type: ignore[misc]
    bench.bridge.add_link(link)
    channel = bench.bridge.channels[1]
    type(peer).congested = property(lambda self: self is peer)  # type: ignore[assignment]
    try:
        if watched:
            bench.bridge.taps.append(SimpleNamespace(frame=lambda time_us, raw: None))
        assert bench.bridge.goes_by_itself() == by_itself
        assert channel.port.spool == (0 if watched else channel.spool_address) and channel.port.congested
    finally:
        del type(peer).congested
    assert bench.bridge.channels[0].port.spool == 0
    bench.bridge.goes_by_itself()
    assert not channel.port.congested


def test_what_is_due_is_behind(bench: Bench) -> None:
    bench.run(3.0)
    bench.command(511, 30, 100_000)
    due = bench.bridge.next_due_us()
    assert due == 3_100_000 < bench.bridge.shell_due_us()
    assert not bench.bridge.is_behind(due - 1) and bench.bridge.is_behind(due)


def test_more_words_than_a_port_has_space_for_are_heard_in_their_order(
    bench: Bench, monkeypatch: pytest.MonkeyPatch
) -> None:
    """What earlier clients said comes first."""
    done: list[tuple[int, ...]] = []
    monkeypatch.setattr(bench.bridge.core, "run_all", lambda *where: done.append(where), raising=False)
    others = [bench.connect(system=250), bench.connect(system=251)]
    for client, count in ((bench.client, 1), (others[0], 60), (others[1], 1)):
        for seq in range(count):
            client.send(mavlink.MAVLink_ping_message(7, seq, 0, 0))
    bench.bridge.go_on(0, 5_000, 0)
    bench.bridge.flush()
    assert [m.seq for m in bench.client.receive("PING")] == [0]
    assert [m.seq for m in others[0].receive("PING")] == list(range(60))
    assert others[1].receive("PING") == [] and bench.bridge.channels[2].port.in_size > 0, "the core hears them"
    assert len(done) == 1 and (done[0][0], done[0][2]) == (2, 0)


def test_a_heartbeat_while_time_stands_is_for_clients_alone(bench: Bench) -> None:
    log = InProcessLink()
    log.peers[0].is_log = True  # type: ignore[misc]
    bench.bridge.add_link(log)
    log.receive()
    bench.client.receive()
    bench.bridge.beat()
    assert [m.get_type() for m in bench.client.receive()] == ["HEARTBEAT"] and log.receive() == b""


def test_clients_with_faults_may_push_the_clock_until_it_is_free(bench: Bench) -> None:
    bench.bridge.set_link_faults(LinkFaults(delay=0.5))
    directions = bench.bridge.channels[0].peer.directions
    assert directions is not None and not bench.bridge.is_clock_pushed
    grants = bench.bridge.push_clock()
    assert bench.bridge.is_clock_pushed and bench.bridge.grants is grants
    assert directions.to_client.passes and directions.to_vehicle.passes
    bench.bridge.free_clock()
    assert not bench.bridge.is_clock_pushed


# ---------------------------------------------------------------- locations


@pytest.mark.parametrize(
    ("frame", "rise", "alt"),
    [
        (0, None, 10.0), (5, 7.0, 10.0), (3, None, 594.0), (6, 7.0, 594.0), (10, 7.0, 601.0), (11, -2.0, 592.0),
        (10, None, None),
    ],
)  # fmt: skip
def test_heights_of_frames(bench: Bench, frame: int, rise: float | None, alt: float | None) -> None:
    bench.vehicle.locate()
    locations = Locations(bench.vehicle.v.autopilot, lambda lat, lon: rise)
    assert locations.alt(*HOME[:2], 10.0, frame) == alt
    found = locations.ned(*HOME[:2], 10.0, frame)
    assert found == (None if alt is None else pytest.approx((0.0, 0.0, HOME[2] - alt)))
    assert locations.over_origin(1.0, 2.0, 600.0) == (1.0, 2.0, -16.0)
    bench.vehicle.v.autopilot.estimate.origin_set = False
    assert locations.over_origin(1.0, 2.0, 600.0) is None is locations.ned(*HOME[:2], 10.0, frame)


@pytest.mark.parametrize(
    ("lat", "lon", "z", "known"),
    [
        (900_000_000, 0, 0.0, True), (900_000_001, 0, 0.0, False), (0, 1_800_000_000, 0.0, True),
        (0, -1_800_000_001, 0.0, False), (0, 0, math.inf, False), (0, 0, math.nan, False),
    ],
)  # fmt: skip
def test_what_is_off_the_globe_is_nowhere(bench: Bench, lat: int, lon: int, z: float, known: bool) -> None:
    bench.vehicle.locate()
    assert (bench.bridge.locations.ned(lat, lon, z, 3) is not None) == known
