# SPDX-License-Identifier: BSD-3-Clause
"""What users of the page do to a vehicle: MAVLink on a link in this process, as from any ground station, so that it is
recorded and replayed. All of it runs where the vehicle is, between two advances."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np

from ..client.commands import command_name, command_number, entry_name
from ..client.controls import POSITION_ONLY
from ..client.endpoint import Endpoint
from ..client.parameters import REAL_32
from ..core.geodesy import add_offset
from ..core.mavlink import ARM_FORCED, MavFrame, MavModeFlag, MavResult
from ..errors import OptionError, did_you_mean
from ..recording.recorder import Recorder
from ..simulation import Simulation, Snapshot
from .incoming import finite
from .sticks import Axes

SYSTEM, COMPONENT = 254, 190
"""MAVLink ids of the page: a second ground station, so that no link of another one is taken for its own."""
GUIDED = "GUIDED"
_REAL_32_MAX = float(np.finfo(np.float32).max)
FARTHEST = 100_000.0
"""From the scene's origin to where a vehicle can be sent [m]."""
_STICKS_US = 100_000
"""Simulated time between two MANUAL_CONTROL [us]."""


class Pilot:
    """A client of a vehicle in this process. Its link is added when it first says something.

    Args:
        simulation: the vehicle.
        report: called with what the vehicle refuses.
    """

    def __init__(self, simulation: Simulation, report: Callable[[str], None]) -> None:
        self._simulation, self._report = simulation, report
        self._endpoint: Endpoint | None = None
        self._driver: Endpoint | None = None
        """Holds the sticks: the vehicle takes them from its pilot's ground station alone (MAV_GCS_SYSID)."""
        self._axes: Axes | None = None
        self._sticks_due_us = 0
        self._snapshot: Snapshot | None = None

    # ------------------------------------------------------------------ MAVLink

    def _client(self) -> Endpoint:
        if self._endpoint is None:
            self._endpoint = Endpoint(system=SYSTEM, component=COMPONENT)
            self._simulation.bridge.add_link(self._endpoint.link)
        return self._endpoint

    def _command(self, name: str, *params: float) -> None:
        self._client().command(command_number(name), *params, target=self._simulation.bridge.system)

    def _send(self, name: str, **fields: Any) -> None:
        target = {"target_system": self._simulation.bridge.system, "target_component": 1}
        self._client().send(name, **target, **fields)

    def hold(self, axes: Axes | None) -> None:
        """Hold the sticks from now on; None: give them back to the radio."""
        had, self._axes, self._sticks_due_us = self._axes, axes, 0
        if axes is None and had is None:
            return
        simulation = self._simulation
        if self._driver is None:
            self._driver = Endpoint(component=COMPONENT)
            simulation.bridge.add_link(self._driver.link)
        self._driver.system = int(simulation.v.autopilot.params.MAV.GCS_SYSID)
        if axes is not None:
            self.keep_sticks()
        else:  # 0 gives channels 1 .. 8 back and leaves the others
            target = {"target_system": simulation.bridge.system, "target_component": 1}
            self._driver.send("RC_CHANNELS_OVERRIDE", **target)

    def keep_sticks(self) -> None:
        """Say where the held sticks are when that falls due: the vehicle soon forgets them (RC_OVERRIDE_TIME)."""
        now = self._simulation.time_us
        if self._driver is None:
            return
        self._driver.receive()
        if self._axes is not None and not 0 < self._sticks_due_us - now <= _STICKS_US:
            self._sticks_due_us = now + _STICKS_US
            self._driver.send("MANUAL_CONTROL", target=self._simulation.bridge.system, **self._axes._asdict())

    def listen(self) -> None:
        """Report commands that were refused since the last call."""
        if self._endpoint is None:
            return
        for name, fields in self._endpoint.receive():
            if name == "COMMAND_ACK" and fields.result not in (0, MavResult.IN_PROGRESS):
                result = entry_name("MAV_RESULT", int(fields.result))
                self._report(f"{command_name(int(fields.command))}: {result}")

    @property
    def _mode(self) -> str:
        return str(self._simulation.firmware.mode_names.get(int(self._simulation.v.autopilot.modes.number), "?"))

    @property
    def _is_armed(self) -> bool:
        return bool(self._simulation.v.autopilot.arming.armed)

    def arm(self) -> None:
        """Arm."""
        self._command("COMPONENT_ARM_DISARM", 1)

    def disarm(self, force: bool = False) -> None:
        """Disarm; ``force``: even in the air."""
        self._command("COMPONENT_ARM_DISARM", 0, ARM_FORCED if force else 0)

    def set_mode(self, name: str) -> None:
        """Choose a mode by its name."""
        numbers = {mode: number for number, mode in self._simulation.firmware.mode_names.items()}
        if name not in numbers:
            raise OptionError(f"there is no mode {name!r}{did_you_mean(name, numbers)}")
        self._command("DO_SET_MODE", MavModeFlag.CUSTOM_MODE_ENABLED, numbers[name])

    def take_off(self, height: float) -> None:
        """GUIDED, armed if need be, to a height above home [m].

        Raises:
            OptionError: the height is no finite number.
        """
        height = finite("height", height)
        if self._mode != GUIDED:
            self.set_mode(GUIDED)
        if not self._is_armed:
            self.arm()
        self._command("NAV_TAKEOFF", 0, 0, 0, 0, 0, 0, height)

    def go_to(self, north: float, east: float) -> None:
        """GUIDED, to a position of the scene [m], at the present height.

        Raises:
            OptionError: it is not armed, or the position is farther than FARTHEST.
        """
        north, east = finite("north", north, FARTHEST), finite("east", east, FARTHEST)
        v = self._simulation.v
        if not self._is_armed:
            raise OptionError("it is not armed: arm it, or take off, before it can go anywhere")
        if self._mode != GUIDED:
            self.set_mode(GUIDED)
        lat, lon = add_offset(v.physics.origin.lat, v.physics.origin.lon, north, east)
        self._send(
            "SET_POSITION_TARGET_GLOBAL_INT", coordinate_frame=MavFrame.GLOBAL_RELATIVE_ALT_INT,
            type_mask=POSITION_ONLY,
            lat_int=round(lat), lon_int=round(lon), alt=v.autopilot.home.pos.z - v.autopilot.estimate.pos.z,
        )  # fmt: skip

    def set_parameter(self, name: str, value: float) -> None:
        """Set a parameter, SIM_ ones, too.

        Raises:
            OptionError: there is no such parameter, or the value is no finite number.
        """
        table = self._simulation.firmware.table
        if name not in table:
            raise OptionError(f"there is no parameter {name!r}{did_you_mean(name, table.names())}")
        value = finite(name, value, _REAL_32_MAX)
        self._send("PARAM_SET", param_id=name.encode(), param_value=value, param_type=REAL_32)

    # ------------------------------------------------------------------ what only a simulator can

    def fail(self, text: str) -> None:
        """Let something fail: "gps@12", "motor:2=0.5" (docs/faults.md)."""
        self._simulation.fail(text)

    def repair(self) -> None:
        """Nothing fails any more."""
        self._simulation.repair()

    def keep(self) -> None:
        """Keep this moment.

        Raises:
            OptionError: the run is being recorded: what a snapshot does cannot be replayed.
        """
        self._refuse_if_recorded()
        self._snapshot = self._simulation.snapshot()

    def go_back(self) -> None:
        """Go on from the moment that was kept.

        Raises:
            OptionError: none was, or the run is being recorded.
        """
        self._refuse_if_recorded()
        if self._snapshot is None:
            raise OptionError("no moment was kept")
        self._simulation.restore(self._snapshot)

    def _refuse_if_recorded(self) -> None:
        if isinstance(self._simulation.bridge.board.journal, Recorder):
            raise OptionError("the run is being recorded (--rec): it cannot go back to another moment")
