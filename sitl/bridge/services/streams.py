# SPDX-License-Identifier: BSD-3-Clause
"""What is sent regularly: ArduPilot's stream groups and single message intervals, per channel.

AVAILABLE_MODES (https://mavlink.io/en/services/standard_modes.html) is sent on request.

Sources: https://mavlink.io/en/guide/message_rates.html, https://ardupilot.org/dev/docs/mavlink-requesting-data.html
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

from ...autopilot.modes import Mode
from ...core.mavlink import MavResult, MavSeverity
from ..channel import Channel
from ..dialect import message
from ..host import Host
from ..listener import Sender
from ..wire.streams import interval_of, set_interval
from .command import Command
from .high_latency import HIGH_LATENCY2, HighLatencyService
from .service import Handler, Service
from .statustext import StatusTextService
from .terrain_protocol import REPORT, TerrainService

AVAILABLE_MODES = message("AVAILABLE_MODES")
OF_PARTS = frozenset(
    (22, 35, 127, 128, 132, 133, 143, 173, 180, 191, 192, 225, 226, 246, 259, 260, 262, 269, 271, 277, 280, 281, 285,
     295, 301, 373, 9005, 10008)
)  # fmt: skip
"""Messages of parts (range-finder, airspeed sensor, camera, gimbal, winch, generator, ...) or of moments: one may ask
for them where the part is missing or off; nothing comes then, as from ArduPilot."""
AUTOMATIC = 4
"""MAV_MODE_PROPERTY_AUTO_MODE: moves without the pilot's sticks."""
NOT_SELECTABLE = 2
"""MAV_MODE_PROPERTY_NOT_USER_SELECTABLE"""


def send_modes(channel: Channel, modes: Sequence[Mode[Any]], index: int) -> bool:
    """Send mode ``index`` (from 1), or all for 0; False when there is no such mode."""
    if not 0 <= index <= len(modes):
        return False
    for k, mode in enumerate(modes, start=1):
        if index in (0, k):
            properties = (AUTOMATIC if mode.autonomous else 0) | (0 if mode.selectable else NOT_SELECTABLE)
            name = (mode.title or mode.name).encode()
            fields = (mode.number, properties, len(modes), k, mode.standard_mode, name)
            channel.send(AVAILABLE_MODES, AVAILABLE_MODES.pack(*fields))
    return True


ALL_STREAMS = 0
MOST_HZ = 400
"""Greatest rate that a parameter tells."""
RATE_PREFIX = "MAV1_"
HEARTBEAT_US = 1_000_000
TIMESYNC_US = 10_000_000
LONGEST_US = 60_000_000
ON_REQUEST_ONLY = frozenset(("AUTOPILOT_VERSION", "STATUSTEXT"))
HEARTBEAT, TIMESYNC = message("HEARTBEAT").id, message("TIMESYNC").id
INTERVAL = message("MESSAGE_INTERVAL")


class StreamService(Service):
    """What is sent regularly: each channel's intervals, as clients ask for them."""

    def __init__(self, bridge: Host) -> None:
        super().__init__(bridge)
        self._groups = bridge.profile.groups
        self._group_of = {message(n).id: group for group, (_, names) in self._groups.items() for n in names}
        self._asked: Mapping[tuple[int, int], int] = {}
        """Rates [Hz] of groups by (number of the channel, group); replaced, never changed."""
        self._first_rates: dict[int, int] = {}
        self._look()

    def handlers(self) -> dict[str, Handler]:
        return {"REQUEST_DATA_STREAM": self._request_data_stream}

    def channel_added(self, channel: Channel) -> None:
        if self.bridge.get(HighLatencyService).has(channel):
            return
        self._set(channel, HEARTBEAT, HEARTBEAT_US)
        self._set(channel, TIMESYNC, TIMESYNC_US)
        for group, rate in self._first_rates.items():
            if rate:
                self.set_group(channel, group, rate)

    def channel_removed(self, channel: Channel) -> None:
        self._asked = {key: rate for key, rate in self._asked.items() if key[0] != channel.number}

    def snapshot(self) -> Any:
        return tuple(self._asked.items()), tuple(self._first_rates.items())

    def restore(self, state: Any) -> None:
        self._asked, self._first_rates = map(dict, state)

    def parameter_changed(self, name: str) -> None:
        """A MAV1_ rate parameter was set: it holds for every channel from now on."""
        for group, (ending, _) in self._groups.items():
            if name == RATE_PREFIX + ending:
                self._first_rates = {**self._first_rates, group: self._rate_parameter(group)}
                for channel in self.bridge.channels:
                    self.set_group(channel, group, self._first_rates[group])

    def _rate_parameter(self, group: int) -> int:
        rate = self.bridge.parameter(RATE_PREFIX + self._groups[group][0])
        return int(rate) if rate is not None and rate > 0 else 0

    def follow(self, other: StreamService) -> None:
        """After a reboot: what a stream's request has set is forgotten, as it was not saved."""
        for group, rate in other._first_rates.items():
            self._keep_rate(group, rate)
        self._look()

    def _look(self) -> None:
        """Rates that channels begin with: what the parameters say before clients ask."""
        self._first_rates = {group: self._rate_parameter(group) for group in self._groups}

    def set_group(self, channel: Channel, group: int, rate_hz: int) -> None:
        """Send a group's messages at ``rate_hz`` (0: stop), whatever was asked for them singly before."""
        self._asked = {**self._asked, (channel.number, group): rate_hz}
        for name in self._groups[group][1]:
            self._set(channel, message(name).id, self._interval_us(rate_hz))

    def _interval_us(self, rate_hz: int) -> int:
        """Of a group's rate, or the shortest one [us]; 0: not sent."""
        return max(1_000_000 // rate_hz, self._shortest_us()) if rate_hz > 0 else 0

    def _set(self, channel: Channel, number: int, interval_us: int) -> None:
        bridge, high_latency = self.bridge, self.bridge.get(HighLatencyService)
        if high_latency.has(channel):
            if number == HIGH_LATENCY2:
                high_latency.set_interval(channel, interval_us)
        elif number in bridge.telemetry:
            set_interval(channel.port, number, interval_us, bridge.now_us, number in bridge.by_shell)
            if number == REPORT.id:
                bridge.get(TerrainService).look()

    def _shortest_us(self) -> int:
        """Messages come at most at 0.8 of SCHED_LOOP_RATE, in whole milliseconds [us]; to who pushes the clock, at
        all of it."""
        bridge = self.bridge
        period_us = 1_000_000 // max(int(bridge.parameter("SCHED_LOOP_RATE") or 400), 1)
        if bridge.is_stepped or bridge.is_clock_pushed:
            return period_us
        return max(period_us // 800, 1) * 1000

    def _request_data_stream(self, channel: Channel, fields: Any, sender: Sender) -> None:
        rate = fields.req_message_rate if fields.start_stop == 1 else 0
        if fields.start_stop > 1:
            return
        wanted = self._groups if fields.req_stream_id == ALL_STREAMS else (fields.req_stream_id,)
        for group in wanted:
            if group in self._groups:
                self.set_group(channel, group, rate)
                if channel is self.bridge.channels[0]:
                    self._keep_rate(group, rate)

    def _keep_rate(self, group: int, rate_hz: int) -> None:
        """The first channel's rates are what its parameters say; other channels do not begin with them."""
        name, values = RATE_PREFIX + self._groups[group][0], self.bridge.vehicle.parameters
        if name in values.table:
            values[name] = float(min(rate_hz, MOST_HZ))

    # ------------------------------------------------------------------ commands

    def set_interval(self, channel: Channel, command: Command) -> int:
        """MAV_CMD_SET_MESSAGE_INTERVAL: p1 message id, p2 interval [us], -1 off, 0 default; p3 must be 0."""
        number, interval = int(command.p1), int(command.p2)
        if command.p3 != 0.0:
            return MavResult.DENIED
        kind = self.bridge.telemetry.get(number)
        say = self.bridge.get(StatusTextService).say
        if kind is None or kind.name in ON_REQUEST_ONLY:
            say(MavSeverity.INFO, f"No ap_message for mavlink id ({number})")
            return MavResult.DENIED
        if interval == 0:
            self._set(channel, number, self._default_interval(channel, number))
            return MavResult.ACCEPTED
        if interval == -1:
            self._set(channel, number, 0)
            return MavResult.ACCEPTED
        if interval < 0:
            return MavResult.DENIED
        if interval < self._shortest_us():
            say(MavSeverity.INFO, f"Requested rate for message ID {number} too fast. Increase SCHED_LOOP_RATE")
            return MavResult.DENIED
        self._set(channel, number, min(interval, LONGEST_US))
        return MavResult.ACCEPTED

    def _default_interval(self, channel: Channel, number: int) -> int:
        """That of its group on this channel, as it was asked for last [us]."""
        if number in (HEARTBEAT, TIMESYNC):
            return HEARTBEAT_US if number == HEARTBEAT else TIMESYNC_US
        group = self._group_of.get(number)
        rate = self._asked.get((channel.number, group), 0) if group is not None else 0
        return self._interval_us(rate)

    def get_interval(self, channel: Channel, command: Command) -> int:
        """MAV_CMD_GET_MESSAGE_INTERVAL: answers MESSAGE_INTERVAL; 0 not available, -1 not sent."""
        number = int(command.p1)
        known = number in self.bridge.telemetry
        interval = (interval_of(channel.port, number) or -1) if known else 0
        if 0 <= number <= 0xFFFF:
            channel.send(INTERVAL, INTERVAL.payload(message_id=number, interval_us=interval))
        return MavResult.ACCEPTED if known else MavResult.FAILED

    def request_message(self, channel: Channel, command: Command) -> int:
        """MAV_CMD_REQUEST_MESSAGE: p1 message id; p2 number of the mode for AVAILABLE_MODES (0: all), or of the message
        for MESSAGE_INTERVAL."""
        if int(command.p1) == AVAILABLE_MODES.id:
            return (
                MavResult.ACCEPTED
                if send_modes(channel, self.bridge.profile.modes, int(command.p2))
                else MavResult.DENIED
            )
        if int(command.p1) == INTERVAL.id:
            return self.get_interval(channel, command._replace(p1=command.p2))
        number = int(command.p1)
        if number == TIMESYNC:
            return MavResult.FAILED
        result = self.bridge.send_after_answer(channel, number)
        return MavResult.ACCEPTED if number in OF_PARTS | self.bridge.profile.silent else result
