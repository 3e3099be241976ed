# SPDX-License-Identifier: BSD-3-Clause
"""A vehicle without a core, an autopilot that writes down what it was asked.

And a client that is pymavlink.
"""

from __future__ import annotations

from typing import Any, TypeVar

from pymavlink.dialects.v20 import ardupilotmega as mavlink

from sitl.autopilot.copter.firmware import FIRMWARE as COPTER
from sitl.autopilot.firmware import Firmware
from sitl.autopilot.mission.validate import check_all
from sitl.autopilot.notes import CurrentChanged, Text
from sitl.autopilot.params.table import Values
from sitl.autopilot.rover.firmware import FIRMWARE as ROVER
from sitl.bridge.bridge import Bridge
from sitl.bridge.links import InProcessLink
from sitl.bridge.wire.message import Message
from sitl.core import rng
from sitl.physics.carried import Carried, carried
from sitl.vehicle.copter import Copter
from sitl.vehicle.rover import Rover

TICK_US = 2500
HOME = (-353632620, 1491652370, 584.0)


class FakeVehicle:
    """A record whose clock the test advances."""

    firmware: Firmware = COPTER
    record: Any = Copter
    has_truth_in_record = has_plain_ground = True

    def __init__(self) -> None:
        self.fleet = self.record.fleet(2)
        self.index = 1
        self.v = self.record.of(self.fleet, 1)
        self.reboots = 0
        self.before_boot_us = 0
        self.firmware.table.set_defaults(self.v.autopilot.params)
        self.parameters = Values(self.firmware.table, self.v.autopilot.params)
        self.v.autopilot.arming.landed = 1

    @property
    def time_us(self) -> int:
        return self.before_boot_us + int(self.v.time_us)

    def truth(self) -> Carried:
        return carried(self.v)

    def reseed(self, seed: int) -> None:
        rng.seed(self.v.rng, seed)

    def request_reboot(self) -> None:
        self.reboots += 1

    def locate(self) -> None:
        """Give it an origin, a home and a GPS fix."""
        estimate, home, sensors = self.v.autopilot.estimate, self.v.autopilot.home, self.v.sensors
        estimate.origin_lat, estimate.origin_lon, estimate.origin_alt = HOME
        estimate.origin_set = estimate.position_ok = 1
        home.lat, home.lon, home.alt, home.is_set = (*HOME, 1)
        sensors.gps_fix, sensors.gps_lat, sensors.gps_lon, sensors.gps_alt = 3, HOME[0], HOME[1], 584000


class FakeRover(FakeVehicle):
    """The same with the rover's record."""

    firmware: Firmware = ROVER
    record: Any = Rover


M = TypeVar("M", bound=Message)


def filled(cls: type[M], **fields: Any) -> M:
    """A message as it comes from the wire with these fields of the dialect; the others are zero."""
    return cls.of_payload(cls.kind.payload(**fields))


class FakeAutopilot:
    """Answers True to everything and keeps the calls."""

    def __init__(self, vehicle: FakeVehicle) -> None:
        self.vehicle = vehicle
        self.calls: list[tuple[Any, ...]] = []
        self.items: tuple[Any, ...] = ()
        self.notes: list[Any] = []
        self.ok = True

    def __getattr__(self, name: str) -> Any:
        if name.startswith("_"):
            raise AttributeError(name)

        def call(*arguments: Any) -> bool:
            self.calls.append((name, *arguments))
            return self.ok

        return call

    def armed(self) -> bool:
        return bool(self.vehicle.v.autopilot.arming.armed)

    def mode(self) -> int:
        return int(self.vehicle.v.autopilot.modes.number)

    def set_mode(self, number: int) -> bool:
        self.calls.append(("set_mode", number))
        if number not in self.vehicle.firmware.mode_names:
            self.notes.append(Text(4, f"No such mode {number}"))
            return False
        self.vehicle.v.autopilot.modes.number = number
        return True

    def is_guided_in_auto(self) -> bool:
        return False

    def take_notes(self) -> list[Any]:
        notes, self.notes = self.notes, []
        return notes

    def home_changed(self) -> None:
        pass

    def jump_to_tag(self, tag: int) -> bool:
        return False

    def mission_items(self) -> tuple[Any, ...]:
        return self.items

    def current_item(self) -> int:
        return int(self.vehicle.v.autopilot.modes.nav.mission_current)

    def replace_mission(self, items: tuple[Any, ...]) -> int:
        result = check_all(items, self.vehicle.firmware.commands.taken)[0]
        if result == 0:
            self.items = items
        return result

    def clear_mission(self) -> bool:
        self.items = ()
        return True

    def set_current_item(self, seq: int, reset: bool = False) -> bool:
        if not 0 <= seq < len(self.items):
            return False
        self.vehicle.v.autopilot.modes.nav.mission_current = seq
        self.notes.append(CurrentChanged(seq))
        return True


class Client:
    """A ground station in the same process: pymavlink packs and parses."""

    def __init__(self, link: InProcessLink, system: int = 255, component: int = 190, version: int = 2) -> None:
        self.link = link
        self.mav = mavlink.MAVLink(None, srcSystem=system, srcComponent=component)
        self.mav.robust_parsing = True
        self.version = version

    def send(self, message: Any) -> None:
        self.link.send(message.pack(self.mav, force_mavlink1=self.version == 1))
        self.mav.seq = (self.mav.seq + 1) % 256

    def receive(self, *types: str) -> list[Any]:
        """Messages since the last call, of these types or of all."""
        found = self.mav.parse_buffer(self.link.receive()) or []
        return [m for m in found if not types or m.get_type() in types]


class Bench:
    """Vehicle, bridge and clients on one clock."""

    def __init__(self, vehicle: FakeVehicle | None = None) -> None:
        self.vehicle = vehicle or FakeVehicle()
        self.autopilot = FakeAutopilot(self.vehicle)
        self.bridge = Bridge(self.vehicle, autopilot=self.autopilot)  # type: ignore[arg-type]
        self.client = self.connect()

    def connect(self, **options: Any) -> Client:
        identity = {k: options.pop(k) for k in ("system", "component", "version") if k in options}
        link = InProcessLink(**options)
        self.bridge.add_link(link)
        return Client(link, **identity)

    def ask(self, message: Any, *types: str) -> list[Any]:
        """Send from the first client and give its answers, without time passing."""
        self.client.send(message)
        self.bridge.receive()
        return self.client.receive(*types)

    def telemetry(self, name: str) -> list[Any]:
        """What one request for a message gives, as a client decodes it."""
        number = next(n for n, kind in self.bridge.telemetry.items() if kind.name == name)
        self.bridge.send_now(self.bridge.channels[0], number)
        self.bridge.flush()
        return self.client.receive(name)

    def run(self, seconds: float) -> None:
        """Let simulated time pass as the simulation does: from one due time to the next."""
        v = self.vehicle.v
        end = int(v.time_us) + round(seconds * 1e6)
        self.bridge.receive()
        while int(v.time_us) < end:
            stop = min(end, self.bridge.next_due_us())
            ticks = max(1, -(-(stop - int(v.time_us)) // TICK_US))
            v.time_us += ticks * TICK_US
            self.bridge.on_events()
            self.bridge.service()

    def command(self, number: int, *p: float, **target: int) -> int:
        """COMMAND_LONG; its MAV_RESULT."""
        values = (*p, *(0.0,) * (7 - len(p)))
        system, component = target.get("system", 1), target.get("component", 1)
        message = mavlink.MAVLink_command_long_message(system, component, number, 0, *values)
        acks = self.ask(message, "COMMAND_ACK")
        assert len(acks) == 1, acks
        assert (acks[0].command, acks[0].target_system, acks[0].target_component) == (number, 255, 190)
        return int(acks[0].result)
