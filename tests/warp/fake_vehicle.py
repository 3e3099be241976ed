# SPDX-License-Identifier: BSD-3-Clause
"""A vehicle that does nothing but talk MAVLink in simulated time and write down when it heard what.

It stands in for the simulator where only the clock of the script matters: TCP server, 1 Hz heartbeat, a few
telemetry streams, command acknowledgements, mission upload. All times are simulated.
"""

from __future__ import annotations

import itertools
import math
import socket
from collections import defaultdict

from pymavlink.dialects.v20 import ardupilotmega as mav

GUIDED, LOITER, AUTO = 4, 5, 3


class FakeVehicle:
    """An ArduPilot-like copter on a TCP port of its own (`port`); drive it with :meth:`advance_to`."""

    def __init__(self) -> None:
        self.server = socket.create_server(("127.0.0.1", 0))
        self.server.setblocking(False)
        self.port = self.server.getsockname()[1]
        self.client: socket.socket | None = None
        self.link = mav.MAVLink(self, srcSystem=1, srcComponent=1)
        self.sim_us = 0
        self.mode = LOITER
        self.armed = False
        self.deaf: set[int] = set()  # commands it never answers
        self.silent_from_us = math.inf  # no heartbeat from here on...
        self.silent_on: int | None = None  # ...set by receiving this command
        self.received: dict[str, list[int]] = defaultdict(list)  # message or COMMAND_<n>: simulated times [us]
        self.mission_items: list[mav.MAVLink_message] = []
        self.mission_size = 0
        self.position_period_us = 200_000
        self._next = {"heartbeat": 0, "attitude": 0, "position": 0, "status": 0}
        self.quiet_telemetry = False

    # --- time ---
    def advance_to(self, sim_us: int) -> None:
        """Live until simulated time `sim_us`: hear what came in, then send what fell due."""
        self._listen()
        while (due := min(self._next.values())) <= sim_us:
            self.sim_us = due
            self._emit()
        self.sim_us = sim_us

    def _due(self, name: str, period_us: int) -> bool:
        if self._next[name] > self.sim_us:
            return False
        self._next[name] = self.sim_us + period_us
        return True

    def _emit(self) -> None:
        ms = self.sim_us // 1000
        if self._due("heartbeat", 1_000_000) and self.sim_us < self.silent_from_us:
            self._heartbeat()
        silent = self.quiet_telemetry or self.sim_us >= self.silent_from_us
        if self._due("attitude", 50_000) and not silent:
            self.link.attitude_send(ms, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0)
        if self._due("position", self.position_period_us) and not silent:
            self.link.global_position_int_send(ms, 473977420, 85455940, 488000, 10000, 0, 0, 0, 0)
            self.link.local_position_ned_send(ms, 0.0, 0.0, -10.0, 0.0, 0.0, 0.0)
        if self._due("status", 500_000) and not silent:
            health = 0x1000002F
            self.link.sys_status_send(health, health, health, 100, 12000, 100, 90, 0, 0, 0, 0, 0, 0)
            self.link.gps_raw_int_send(self.sim_us, 3, 473977420, 85455940, 488000, 80, 80, 0, 0, 12)

    def _heartbeat(self) -> None:
        base = mav.MAV_MODE_FLAG_CUSTOM_MODE_ENABLED | (mav.MAV_MODE_FLAG_SAFETY_ARMED if self.armed else 0)
        self.link.heartbeat_send(mav.MAV_TYPE_QUADROTOR, mav.MAV_AUTOPILOT_ARDUPILOTMEGA, base, self.mode, 4)

    # --- the wire ---
    def write(self, data: bytes) -> None:
        """MAVLink's output: to the client if there is one."""
        if self.client is not None:
            try:
                self.client.sendall(data)
            except OSError:
                self._hang_up()

    def _hang_up(self) -> None:
        if self.client is not None:
            self.client.close()
            self.client = None

    def _listen(self) -> None:
        if self.client is None:
            try:
                self.client, _ = self.server.accept()
                self.client.setsockopt(socket.IPPROTO_TCP, socket.TCP_NODELAY, 1)
            except BlockingIOError:
                return
        try:
            data = self.client.recv(65536, socket.MSG_DONTWAIT)
        except BlockingIOError:
            return
        except OSError:
            data = b""
        if not data:
            self._hang_up()
            return
        for message in self.link.parse_buffer(data) or []:
            self._hear(message)

    def _hear(self, m: mav.MAVLink_message) -> None:
        name = m.get_type()
        self.received[name].append(self.sim_us)
        if name in ("COMMAND_LONG", "COMMAND_INT"):
            self._command(m)
        elif name == "MISSION_COUNT":
            self.mission_size, self.mission_items = m.count, []
            self._ask(m, 0)
        elif name == "MISSION_ITEM_INT" and m.seq == len(self.mission_items):
            self.mission_items.append(m)
            if len(self.mission_items) < self.mission_size:
                self._ask(m, len(self.mission_items))
            else:
                self.link.mission_ack_send(m.get_srcSystem(), m.get_srcComponent(), 0, m.mission_type)

    def _ask(self, m: mav.MAVLink_message, seq: int) -> None:
        self.link.mission_request_int_send(m.get_srcSystem(), m.get_srcComponent(), seq, m.mission_type)

    def _command(self, m: mav.MAVLink_message) -> None:
        self.received[f"COMMAND_{m.command}"].append(self.sim_us)
        if m.command == self.silent_on:
            self.silent_from_us = self.sim_us
        if m.command in self.deaf:
            return
        if m.command == mav.MAV_CMD_DO_SET_MODE:
            self.mode = int(m.param2)
        elif m.command == mav.MAV_CMD_COMPONENT_ARM_DISARM:
            self.armed = m.param1 == 1
        self.link.command_ack_send(m.command, 0, 0, 0, m.get_srcSystem(), m.get_srcComponent())
        if m.command in (mav.MAV_CMD_DO_SET_MODE, mav.MAV_CMD_COMPONENT_ARM_DISARM):
            self._heartbeat()
        if m.command == mav.MAV_CMD_REQUEST_MESSAGE and int(m.param1) == 148:
            self.link.autopilot_version_send(0xFBEF, 0x04070000, 0, 0, 0, [0] * 8, [0] * 8, [0] * 8, 0, 0, 1)
        if m.command == mav.MAV_CMD_REQUEST_MESSAGE and int(m.param1) == 242:
            self.link.home_position_send(473977420, 85455940, 488000, 0, 0, 0, [1, 0, 0, 0], 0, 0, 0)

    # --- what was heard ---
    def intervals(self, name: str) -> list[float]:
        """Simulated seconds between one `name` and the next."""
        times = self.received[name]
        return [(b - a) / 1e6 for a, b in itertools.pairwise(times)]

    def close(self) -> None:
        """Close both sockets."""
        self._hang_up()
        self.server.close()
