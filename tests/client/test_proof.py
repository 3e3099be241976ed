# SPDX-License-Identifier: BSD-3-Clause
"""What a client believes of a vehicle comes from that vehicle, and what makes it believe in a simulator."""

from __future__ import annotations

import contextlib
import re
import socket
import threading
from collections.abc import Callable
from typing import Any

import pytest

from sitl import Simulation
from sitl.bridge.dialect import message
from sitl.bridge.frame import Splitter, encode_v2
from sitl.client import Client, InProcess, LinkLostError, connect, proof
from sitl.client.byte_socket import ByteSocket
from sitl.client.connection import Connection, Remote
from sitl.client.endpoint import Endpoint, Inbox
from sitl.client.proof import BY_NAME, PARAMETER_NAME
from sitl.envs.mavlink.last_messages import StepTelemetry
from tests.ports import free_port

REQUEST, ACCEPTED, FAILED = 512, 0, 4
VERSION, TRUTH = message("AUTOPILOT_VERSION").id, message("SIMSTATE").id
QUAD, STATION, AUTOPILOT, PIXHAWK = 2, 6, 3, 50 << 16
Frame = tuple[str, dict[str, Any]]


def frame(name: str, system: int = 1, component: int = 1, **fields: Any) -> bytes:
    kind = message(name)
    return encode_v2(kind, kind.payload(**fields), 0, system, component)


def heartbeat(system: int = 1, component: int = 1, type: int = QUAD, autopilot: int = AUTOPILOT) -> bytes:
    return frame("HEARTBEAT", system, component, type=type, autopilot=autopilot, custom_mode=4, base_mode=128)


def parameter(system: int = 1, component: int = 1, index: int = BY_NAME, name: str = PARAMETER_NAME) -> bytes:
    fields = {"param_id": name.encode(), "param_value": 1.0, "param_count": 900, "param_index": index}
    return frame("PARAM_VALUE", system, component, **fields)


def ack(system: int = 1, result: int = ACCEPTED, to: tuple[int, int] = (255, 190)) -> bytes:
    target = {"target_system": to[0], "target_component": to[1]}
    return frame("COMMAND_ACK", system, command=REQUEST, result=result, **target)


class Answers:
    """A vehicle that gives all signs, unless it is told otherwise."""

    def __init__(self, system: int = 1, **changed: Any) -> None:
        self.system = system
        self.parameter = parameter(system)
        self.truth = ack(system) + frame("SIMSTATE", system)
        self.version = ack(system) + frame("AUTOPILOT_VERSION", system)
        vars(self).update(changed)
        self.heard: list[Frame] = []

    def __call__(self, name: str, fields: Any) -> bytes:
        if fields.target_system not in (0, self.system):
            return b""
        self.heard.append((name, fields))
        if name == "PARAM_REQUEST_READ":
            return self.parameter
        return self.truth if fields.param1 == TRUTH else self.version


class Piped(Connection):
    """A link in this process that everybody hears and speaks on."""

    def __init__(self, *vehicles: Callable[[str, Any], bytes]) -> None:
        super().__init__(Endpoint())
        self.vehicles, self._splitter = vehicles, Splitter()
        self.sequences = [100 * number for number in range(len(vehicles))]

    name = "pipe"

    def run(self, us: int) -> None:
        sent = self._splitter.feed(self.endpoint.link.peers[0].take())
        for each in sent:
            for number, vehicle in enumerate(self.vehicles):
                self.bring(number, vehicle(each.kind.name, each.kind.decode(each.payload)))

    def bring(self, number: int, data: bytes) -> None:
        """What a vehicle says, numbered as its own frames are."""
        for each in Splitter().feed(data):
            self.sequences[number] = (self.sequences[number] + 1) & 0xFF
            self.inbox.feed(encode_v2(each.kind, each.payload, self.sequences[number], each.system, each.component))


def met(*vehicles: Callable[[str, Any], bytes], system: int = 1) -> Piped:
    """A link on which the vehicle of this system was heard first."""
    link = Piped(*vehicles)
    link.inbox.feed(heartbeat(system))
    return link


def test_a_vehicle_that_gives_all_signs_is_a_simulator_and_is_asked_under_its_own_ids() -> None:
    vehicle = Answers(system=3)
    link = met(vehicle, system=3)
    assert not link.is_simulator and link.prove() and link.is_simulator
    assert {(fields.target_system, fields.target_component) for _, fields in vehicle.heard} == {(3, 1)}


def test_the_simulator_itself_gives_them() -> None:
    assert InProcess(Simulation("erle_rover")).prove()


LISTED, OF_COMPANION = parameter(index=7), parameter(component=191)
UNTOLD, OF_OTHERS = ack(to=(0, 0)) + frame("SIMSTATE"), ack(to=(254, 190)) + frame("SIMSTATE")


@pytest.mark.parametrize(("changed", "why"), [
    ({"parameter": b""}, f"it does not give its parameter {PARAMETER_NAME}"),
    ({"parameter": LISTED}, f"it does not give its parameter {PARAMETER_NAME}"),
    ({"parameter": OF_COMPANION}, f"it does not give its parameter {PARAMETER_NAME}"),
    ({"parameter": parameter(name="SIM_WIND_DIR")}, f"it does not give its parameter {PARAMETER_NAME}"),
    ({"parameter": frame("PARAM_ERROR", param_id=PARAMETER_NAME.encode())}, "it says that it has no parameter"),
    ({"truth": b""}, "it does not send SIMSTATE"),
    ({"truth": ack()}, "it does not send SIMSTATE"),
    ({"truth": frame("SIMSTATE")}, "it does not send SIMSTATE"),
    ({"truth": UNTOLD}, "it does not send SIMSTATE"),
    ({"truth": OF_OTHERS}, "it does not send SIMSTATE"),
    ({"truth": ack(result=FAILED)}, "it refuses SIMSTATE"),
    ({"truth": ack(result=FAILED) + frame("SIMSTATE")}, "it refuses SIMSTATE"),
    ({"truth": ack(result=FAILED, to=(0, 0)) + ack() + frame("SIMSTATE")}, "it refuses SIMSTATE"),
    ({"version": ack(result=3, to=(255, 0)) + ack() + frame("AUTOPILOT_VERSION")}, "it refuses SIMSTATE"),
    ({"version": b""}, "it does not send"),
    ({"version": ack() + frame("AUTOPILOT_VERSION", board_version=PIXHAWK)}, r"a flight controller \(board 50"),
    ({"version": ack() + frame("AUTOPILOT_VERSION", vendor_id=0x1209, product_id=0x5741)}, "USB 1209:5741"),
])  # fmt: skip
def test_one_that_lacks_a_sign_is_not(changed: dict[str, bytes], why: str) -> None:
    link = met(Answers(**changed))
    assert not link.prove()
    assert re.search(why, link.doubt), link.doubt


HIDDEN = {"parameter": b"", "truth": ack(result=FAILED), "version": ack() + frame("AUTOPILOT_VERSION")}


@pytest.mark.parametrize("order", [1, -1])
@pytest.mark.parametrize("missing", ["parameter", "truth"])
def test_another_systems_signs_prove_nothing(missing: str, order: int) -> None:
    """Even of one that answers everything it hears, as one does that answers another station."""
    other = Answers(system=2)
    chatter = other.parameter + other.truth + other.version
    vehicles = [Answers(**{missing: HIDDEN[missing]}), lambda name, fields: chatter][::order]
    link = met(*vehicles)
    link.inbox.feed(chatter)
    assert not link.prove()


@pytest.mark.parametrize("order", [1, -1])
def test_a_simulator_with_the_same_ids_proves_nothing(order: int) -> None:
    """Its answers cannot be told from those of the vehicle; that there are two of them can be."""
    for changed in ({"parameter": b""}, HIDDEN):
        link = met(*[Answers(**changed), Answers()][::order])
        assert not link.prove()
        assert "more often than it is asked" in link.doubt or "refuses" in link.doubt


class Heard(Piped):
    """A link that brings something else each time that it is listened to so long [us]."""

    def __init__(self, *vehicles: Any, **brought: list[bytes]) -> None:
        super().__init__(*vehicles)
        self.brought = {getattr(proof, name): list(each) for name, each in brought.items()}

    def listen(self, us: int) -> None:
        for each in self.brought.get(us, []):
            self.bring(0, each)
        super().listen(us)


def states(*modes: int) -> list[bytes]:
    return [frame("HEARTBEAT", type=QUAD, autopilot=AUTOPILOT, custom_mode=mode, base_mode=128) for mode in modes]


def test_what_is_heard_after_the_signs_may_contradict_them() -> None:
    for brought, why in (
        ({"CONTRADICTION_US": states(4, 5, 4)}, "say by turns"),
        ({"CONTRADICTION_US": states(4, 5), "CHANGE_US": states(4)}, "say by turns"),
        ({"CONTRADICTION_US": [frame("ATTITUDE", time_boot_ms=7)]}, "while its time stands"),
        ({"CONTRADICTION_US": states(4, 5), "CHANGE_US": states(5, 5)}, ""),  # another station has changed the mode
    ):
        link = Heard(Answers(), **brought)
        link.inbox.feed(heartbeat())
        assert link.prove() == (not why) and why in link.doubt


def test_a_simulator_proves_itself_on_a_link_that_repeats_what_it_says_but_not_what_it_hears() -> None:
    class Repeating(Piped):
        def bring(self, number: int, data: bytes) -> None:
            feed = self.inbox.feed
            self.inbox.feed = lambda data: feed(2 * data)
            super().bring(number, data)
            self.inbox.feed = feed

    link = Repeating(Answers())
    link.inbox.feed(heartbeat())
    assert link.prove(), link.doubt
    answers = Answers()
    assert not met(lambda name, fields: 2 * answers(name, fields)).prove()


def test_a_simulator_proves_itself_beside_a_vehicle_that_is_none() -> None:
    real = Answers(system=2, **HIDDEN)
    assert met(real, Answers()).prove() and not real.heard


def test_the_proof_is_forgotten_when_it_is_asked_anew() -> None:
    vehicle = Answers()
    link = met(vehicle)
    assert link.prove()
    vehicle.parameter = b""
    assert not link.prove() and not link.is_simulator


# ---------------------------------------------------------------------- what counts


STRANGERS = {
    "another system before the vehicle": [frame("ATTITUDE", 2), parameter(2), ack(2), frame("STATUSTEXT", 2)],
    "a ground station's heartbeat": [heartbeat(255, 190, STATION, 8), heartbeat(254, 1, STATION, 8)],
    "a ground station's with the autopilot's ids": [heartbeat(1, 1, STATION, AUTOPILOT)],
    "a companion's and a gimbal's": [heartbeat(1, 191, 18, 8), heartbeat(1, 154, 26, 8), heartbeat(1, 1, 18, 8)],
}


@pytest.mark.parametrize("make", [Inbox, lambda: StepTelemetry(8)], ids=["Inbox", "StepTelemetry"])
@pytest.mark.parametrize("who", STRANGERS)
def test_until_the_vehicle_is_heard_nothing_counts(who: str, make: Callable[[], Any]) -> None:
    inbox = make()
    for data in STRANGERS[who]:
        inbox.feed(data)
    assert (inbox.system, inbox.count, inbox.parameters, inbox.acks, inbox.last_texts) == (0, 0, {}, {}, [])
    inbox.feed(heartbeat(7))
    assert inbox.system == 7
    for data in STRANGERS[who]:
        inbox.feed(data)
    assert (inbox.system, inbox.count, inbox.parameters, inbox.acks, inbox.last_texts) == (7, 0, {}, {}, [])


@pytest.mark.parametrize("make", [Inbox, lambda: StepTelemetry(8)], ids=["Inbox", "StepTelemetry"])
def test_a_heartbeat_that_is_no_vehicles_changes_no_mode(make: Callable[[], Any]) -> None:
    inbox, seen = make(), list[str]()
    inbox.on_message = lambda name, fields: seen.append(name)
    inbox.feed(heartbeat())
    before = getattr(inbox, "mode", seen.copy())
    kind = message("HEARTBEAT")
    inbox.feed(encode_v2(kind, kind.payload(type=STATION, autopilot=8, custom_mode=9), 0, 1, 1))
    assert getattr(inbox, "mode", seen) == before


@pytest.mark.parametrize("make", [Inbox, lambda: StepTelemetry(8)], ids=["Inbox", "StepTelemetry"])
def test_what_another_station_is_answered_does_not_count(make: Callable[[], Any]) -> None:
    link = Connection(Endpoint(), make())
    link.inbox.feed(heartbeat())
    for to in ((254, 190), (255, 1)):
        link.inbox.feed(ack(to=to))
    assert link.inbox.acks == {}
    for to in ((255, 190), (0, 0), (255, 0)):
        link.inbox.acks.clear()
        link.inbox.feed(ack(to=to))
        assert REQUEST in link.inbox.acks


def test_nothing_is_sent_to_a_vehicle_that_was_not_heard() -> None:
    """Target 0 would be everybody."""
    link = Piped()
    with pytest.raises(LinkLostError, match="no vehicle has been heard"):
        link.request(400, (0.0, 21196.0))
    with pytest.raises(LinkLostError, match="no vehicle has been heard"):
        link.ask_parameter(PARAMETER_NAME)
    assert link.endpoint.link.peers[0].take() == b""


def test_a_mission_is_not_mixed_up_with_a_fence_and_a_file_not_with_anothers() -> None:
    """Another station may have the same ids, as most ground stations do."""
    vehicle = Client(Simulation("erle_rover"))
    other = Endpoint()
    vehicle.simulation.bridge.add_link(other.link)
    home = vehicle.item("NAV_WAYPOINT")
    vehicle.wait_ready()
    vehicle.upload([home, vehicle.item("NAV_WAYPOINT", 20, 20)])
    take, fed = vehicle._take, list[str]()

    def disturbed(name: str, fields: Any) -> None:
        if name in ("MISSION_COUNT", "MISSION_ITEM_INT") and name not in fed:
            fed.append(name)
            take(name, fields._replace(mission_type=1, **({"count": 5} if name == "MISSION_COUNT" else {"x": 1})))
        if name == "FILE_TRANSFER_PROTOCOL" and fields.payload[3] == 128:  # ACK, under another number
            payload = list(fields.payload)
            payload[1] ^= 0x40
            payload[12:] = [0] * (len(payload) - 12)
            take(name, fields)
            take(name, fields._replace(payload=tuple(payload)))
            return
        take(name, fields)

    vehicle.connection.inbox.on_message = disturbed
    items = vehicle.download()
    assert len(items) == 2 and items[1].x not in (0, 1) and fed == ["MISSION_COUNT", "MISSION_ITEM_INT"]
    content = vehicle.read_file("@PARAM/param.pck")
    vehicle.connection.inbox.on_message = take
    assert content == vehicle.read_file("@PARAM/param.pck")


# ---------------------------------------------------------------------- senders of datagrams


def test_a_listener_speaks_to_the_sender_of_the_vehicles_heartbeat_and_hears_no_other() -> None:
    with (
        socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as station,
        socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as vehicle,
        socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as late,
    ):
        for each in (station, vehicle, late):
            each.bind(("127.0.0.1", 0))
            each.settimeout(2.0)
        port = free_port()
        stream = ByteSocket(f"udp:127.0.0.1:{port}")
        link = Remote(stream, None, 2.0)
        to = ("127.0.0.1", port)
        station.sendto(heartbeat(255, 190, STATION, 8) + parameter(1), to)
        vehicle.sendto(frame("ATTITUDE") + heartbeat(), to)
        late.sendto(heartbeat(1) + parameter(1), to)
        link.find()
        assert link.system == 1 and link.inbox.parameters == {}
        late.sendto(parameter(1), to)
        vehicle.sendto(parameter(1, name="RTL_ALT"), to)
        link.exchange(lambda: bool(link.inbox.parameters))
        assert set(link.inbox.parameters) == {"RTL_ALT"}
        link.ask_parameter(PARAMETER_NAME)
        stream.flush()
        assert vehicle.recv(1 << 12)
        stream.close()


@pytest.mark.parametrize("wanted", [1, 2])
def test_the_vehicle_that_is_named_is_waited_for(wanted: int) -> None:
    with contextlib.ExitStack() as stack:
        vehicles = [stack.enter_context(socket.socket(socket.AF_INET, socket.SOCK_DGRAM)) for _ in range(2)]
        port = free_port()
        stream = ByteSocket(f"udp:127.0.0.1:{port}")
        stack.callback(stream.close)
        link = Remote(stream, None, 2.0)
        link.inbox.system = wanted
        for system, each in enumerate(vehicles, 1):
            each.sendto(heartbeat(system), ("127.0.0.1", port))
        link.find()
        assert link.system == wanted and stream.peer is not None
        assert stream.peer[1] == vehicles[wanted - 1].getsockname()[1]


def test_one_that_is_named_and_not_there_is_not_found() -> None:
    with socket.create_server(("127.0.0.1", 0)) as server:
        port, asked = server.getsockname()[1], bytearray()

        def vehicle() -> None:
            peer, _ = server.accept()
            with peer:
                peer.sendall(heartbeat(1))
                while data := peer.recv(1 << 12):
                    asked.extend(data)

        thread = threading.Thread(target=vehicle)
        thread.start()
        with pytest.raises(LinkLostError, match="no vehicle of system 2 answers within"):
            connect(f"tcp:127.0.0.1:{port}", patience=0.1, target=2)
        thread.join()
    assert {each.kind.decode(each.payload).target_system for each in Splitter().feed(bytes(asked))} == {2}
