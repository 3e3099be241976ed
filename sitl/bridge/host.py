# SPDX-License-Identifier: BSD-3-Clause
"""What MAVLink's services know of the bridge that has them.

Services stand below the bridge: the bridge makes them and calls them, and is a ``Host`` to them. A service that needs
more than all do says so beside itself (``services/commands.py: CommandHost``).
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import Any, Protocol

from ..autopilot.mission.item import MissionItem
from ..core.record_reader import RecordReader
from .autopilot_api import Autopilot, Vehicle
from .channel import Channel
from .dialect import MessageType
from .links.link import Link
from .listener import Listener
from .locations import Locations
from .log_store import LogStore
from .mavlink_firmware import MavlinkFirmware


class Host(Protocol):
    """One vehicle, its clients, and what services do through the bridge. Times are simulated [us]."""

    vehicle: Vehicle
    autopilot: Autopilot
    """What clients may ask of the vehicle."""
    reader: RecordReader
    """Fields of the vehicle's record by name, as functions that read them."""
    channels: list[Channel]
    """Of all clients."""
    locations: Locations
    epoch_us: int
    """Unix time at the start of the simulation."""
    logs: LogStore | None
    """On-board logs that clients may download."""
    listeners: list[Listener]
    """Are notified of texts, parameters, commands and progress."""
    telemetry: dict[int, MessageType]
    """Every message that can be sent, by its number."""
    by_shell: dict[int, Callable[[], bytes]]
    """Of these, the ones that Python builds: functions that give the payload now."""
    is_stepped: bool
    """Whether somebody in this process steps the vehicle, and wants messages of every tick."""

    @property
    def profile(self) -> MavlinkFirmware:
        """What the firmware is on MAVLink."""
        ...

    @property
    def links(self) -> Sequence[Link]:
        """Links on which clients may come."""
        ...

    @property
    def is_clock_pushed(self) -> bool:
        """Whether clients grant the vehicle its time."""
        ...

    @property
    def now_us(self) -> int:
        """Time since the last boot."""
        ...

    @property
    def elapsed_us(self) -> int:
        """Time since the start of the simulation; a reboot does not set it back."""
        ...

    @property
    def system(self) -> int:
        """The vehicle's system id (MAV_SYSID)."""
        ...

    def get(self, kind: type[Any]) -> Any:
        """The service of this class."""
        ...

    def parameter(self, name: str) -> float | None:
        """Present value of a parameter, None when the firmware has none of this name."""
        ...

    # ------------------------------------------------------------------ messages to clients

    def send_now(self, channel: Channel, number: int) -> bool:
        """Answer a client with one telemetry message, for logs too; False when there is none of this number."""
        ...

    def send_after_answer(self, channel: Channel, number: int) -> int:
        """Send one telemetry message behind the answer to the command that asks for it. Returns the MAV_RESULT."""
        ...

    def send_to_all(self, number: int) -> None:
        """Send one telemetry message to every channel."""
        ...

    def broadcast(self, kind: MessageType, payload: bytes) -> None:
        """Send to every channel."""
        ...

    def say_pending(self) -> None:
        """Report to clients what the core emitted and what the autopilot's laws gave back meanwhile."""
        ...

    def report(self, notes: list[Any]) -> None:
        """Report to clients what the mission's sequencer gave back."""
        ...

    # ------------------------------------------------------------------ what has happened, for other services

    def parameter_changed(self, name: str) -> None:
        """A parameter was set: services follow."""
        ...

    def refresh_identity(self) -> None:
        """Take over a changed MAV_SYSID."""
        ...

    def arming_changed(self) -> None:
        """The vehicle was armed or disarmed: services follow."""
        ...

    def keep_parameters(self, names: Sequence[str]) -> None:
        """Parameters were changed by the firmware, for good."""
        ...

    def carry_out(self, item: MissionItem) -> None:
        """Do what a mission asks of servo outputs, relays, camera, gimbal, payload and switches."""
        ...

    def switched(self, function: int, position: int) -> None:
        """A switch of gimbal or payload was moved."""
        ...
