# SPDX-License-Identifier: BSD-3-Clause
"""What QGroundControl asks on connecting, in its order: every step is answered or refused, so that it goes on.

Steps: https://docs.qgroundcontrol.com/master/en/qgc-dev-guide/communication_flow.html and the initial connect
sequence that QGroundControl shows as its progress bar.
"""

from __future__ import annotations

import struct
import time
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import pytest
from pymavlink import mavutil

from sitl.simulation import Core
from tests.clients.conftest import serve

pytestmark = pytest.mark.slow

ACCEPTED, UNSUPPORTED, FAILED = 0, 3, 4
REQUEST_MESSAGE = 512
FTP_HEADER = struct.Struct("<HBBBBBBI")


class GroundStation:
    """255/190 with a heartbeat, on TCP."""

    def __init__(self, port: int) -> None:
        self.link = mavutil.mavlink_connection(f"tcp:127.0.0.1:{port}", source_system=255, source_component=190)
        assert self.link.wait_heartbeat(timeout=60) is not None  # pymavlink speaks MAVLink 2 once it has heard it
        self.mav = self.link.mav
        self.mav.heartbeat_send(6, 8, 0, 0, 4)

    def receive(self, *kinds: str, until: Callable[[Any], bool] = lambda m: True) -> Any:
        while True:
            message = self.link.recv_match(type=list(kinds), blocking=True, timeout=30.0)
            assert message is not None, f"no {' or '.join(kinds)}"
            if until(message):
                return message

    def command(self, number: int, *params: float, component: int = 1) -> int:
        self.mav.command_long_send(1, component, number, 0, *params, *(0,) * (7 - len(params)))
        return int(self.receive("COMMAND_ACK", until=lambda m: m.command == number).result)

    def request(self, number: int, kind: str, p2: float = 0.0) -> Any:
        """A message asked for, which comes with its acknowledgement, in either order."""
        self.mav.command_long_send(1, 1, REQUEST_MESSAGE, 0, number, p2, 0, 0, 0, 0, 0)
        got = [self.receive("COMMAND_ACK", kind), self.receive("COMMAND_ACK", kind)]
        answers = {m.get_type(): m for m in got}
        assert answers["COMMAND_ACK"].result == ACCEPTED
        return answers[kind]

    def ftp(
        self, opcode: int, data: bytes = b"", size: int | None = None, session: int = 0
    ) -> Iterator[tuple[int, bytes]]:
        """Opcodes and data of the answers to one FTP request."""
        head = FTP_HEADER.pack(1, session, opcode, len(data) if size is None else size, 0, 0, 0, 0)
        self.mav.file_transfer_protocol_send(0, 1, 1, list((head + data).ljust(251, b"\0")))
        while True:
            payload = bytes(self.receive("FILE_TRANSFER_PROTOCOL").payload)
            _, _, answer, length, _, complete, _, _ = FTP_HEADER.unpack_from(payload)
            yield answer, payload[FTP_HEADER.size : FTP_HEADER.size + length]
            if complete:
                return


@pytest.mark.parametrize(
    ("vehicle", "kind", "names"),
    [
        ("copter", 2, {"STABILIZE", "GUIDED", "AUTO", "RTL"}),
        ("rover", 10, {"MANUAL", "STEERING", "HOLD", "GUIDED", "AUTO", "RTL", "SMART_RTL"}),
    ],
)
def test_initial_connect(core: Core, tmp_path: Path, vehicle: str, kind: int, names: set[str]) -> None:
    with serve(tmp_path, vehicle=vehicle) as port:
        station = GroundStation(port)
        assert station.receive("HEARTBEAT").type == kind
        for stream, rate in ((1, 2), (2, 2), (3, 2), (6, 3), (10, 10), (11, 10), (12, 3)):
            station.mav.request_data_stream_send(1, 1, stream, rate, 1)

        version = station.request(148, "AUTOPILOT_VERSION")
        assert version.flight_sw_version >> 24 == 4
        modes = [station.request(435, "AVAILABLE_MODES", 1)]
        modes += [station.request(435, "AVAILABLE_MODES", k) for k in range(2, modes[0].number_modes + 1)]
        assert names <= {m.mode_name for m in modes}
        assert station.command(REQUEST_MESSAGE, 397) == ACCEPTED  # component metadata
        for number in (300, 395, 436):  # protocol version, component information, current mode
            assert station.command(REQUEST_MESSAGE, number) == FAILED

        station.mav.param_request_list_send(1, 0)
        seen: dict[int, str] = {}
        total = 1
        while len(seen) < total:
            value = station.receive("PARAM_VALUE")
            seen[value.param_index], total = value.param_id, value.param_count
        assert len(set(seen.values())) == total

        for plan in (0, 1, 2):  # mission, fence, rally points
            station.mav.mission_request_list_send(1, 1, plan)
            count = station.receive("MISSION_COUNT")
            assert (count.count, count.mission_type) == (0, plan)
            station.mav.mission_ack_send(1, 1, 0, plan)

        assert {"ATTITUDE", "SYS_STATUS", "VFR_HUD", "GPS_RAW_INT"} <= {
            station.receive(kind).get_type() for kind in ("ATTITUDE", "SYS_STATUS", "VFR_HUD", "GPS_RAW_INT")
        }


def test_parameters_by_ftp(core: Core, tmp_path: Path) -> None:
    with serve(tmp_path) as port:
        station = GroundStation(port)
        ((answer, size),) = [next(station.ftp(4, b"@PARAM/param.pck?withdefaults=1", session=200))]
        assert answer == 128
        pieces = list(station.ftp(15, size=239, session=200))
        assert all(answer == 128 for answer, _ in pieces)
        assert len(b"".join(data for _, data in pieces)) == struct.unpack("<I", size)[0]
        assert next(station.ftp(1, session=200))[0] == 128


def test_questions_to_what_is_not_there_are_refused(core: Core, tmp_path: Path) -> None:
    with serve(tmp_path) as port:
        station = GroundStation(port)
        assert station.command(REQUEST_MESSAGE, 411) == FAILED  # events
        for number in (259, 280):  # camera, gimbal manager: missing, nothing comes
            assert station.command(REQUEST_MESSAGE, number) == ACCEPTED
        for number in (521, 527, 31000):  # camera information (old), storage, a command that nobody has
            assert station.command(number, 1) == UNSUPPORTED
        assert station.command(511, 24, 500_000) == ACCEPTED
        station.mav.timesync_send(0, 123456789)
        assert station.receive("TIMESYNC", until=lambda m: m.tc1 != 0).ts1 == 123456789
        station.mav.ping_send(1, 7, 0, 0)
        assert station.receive("PING").seq == 7


def test_a_rover_drives_in_real_time(core: Core, tmp_path: Path) -> None:
    """By TCP, as a ground station would at 1x: arm, drive north, hold, disarm."""
    hold, guided, armed = 4, 15, 128
    began = time.monotonic()
    with serve(tmp_path, "--estimator", "truth", vehicle="rover") as port:
        station = GroundStation(port)
        assert station.command(511, 32, 100_000) == ACCEPTED
        assert station.command(176, 1, guided) == ACCEPTED
        station.receive("STATUSTEXT", until=lambda m: m.text == "ArduPilot Ready")
        assert station.command(400, 1, 2989) == ACCEPTED  # without the checks, which take 20 s
        station.receive("HEARTBEAT", until=lambda m: m.base_mode & armed)
        first = station.receive("LOCAL_POSITION_NED").time_boot_ms
        for half in range(1, 9):
            station.mav.set_position_target_local_ned_send(0, 1, 1, 1, 0xDC7, 0, 0, 0, 1, 0, 0, 0, 0, 0, 0, 0)
            station.mav.heartbeat_send(6, 8, 0, 0, 4)
            at = first + 500 * half
            now = station.receive("LOCAL_POSITION_NED", until=lambda m, at=at: m.time_boot_ms >= at)
        assert now.time_boot_ms <= 1e3 * (time.monotonic() - began), "it may be late, never early"
        assert (now.vx, now.vy) == pytest.approx((1.0, 0.0), abs=0.2)
        assert station.command(176, 1, hold) == ACCEPTED
        station.receive("LOCAL_POSITION_NED", until=lambda m: abs(m.vx) < 0.05)
        assert station.command(400, 0) == ACCEPTED
