# SPDX-License-Identifier: BSD-3-Clause
"""Parameters that clients of a Betaflight find by MAVLink: the SIM_ parameters of our physics. Its own are lines of its
command line."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

from ...bridge.dialect import MessageType, message
from ...core.mavlink import MavParamType
from ...plants.local import LocalPlant
from ...plants.physics_server import SimulatedPlant
from ...vehicle.sim_parameters import PREFIX

_BY_NAME = 0xFFFF
"""``param_index`` of a value that was asked for by its name."""


class SimParameters:
    """See the module.

    Args:
        plant: the physics.
        send: takes kind and payload of each answer.
    """

    def __init__(self, plant: LocalPlant, send: Callable[[MessageType, bytes], None]) -> None:
        self._plant, self._send = SimulatedPlant(plant), send
        self._values = plant.vehicle.v.autopilot.params
        self._names = [name for name in plant.vehicle.kind.firmware.table.names() if name.startswith(PREFIX)]

    def _report(self, name: str, index: int) -> None:
        kind = message("PARAM_VALUE")
        payload = kind.payload(
            param_id=name.encode(), param_value=float(self._values[name]), param_type=MavParamType.REAL32,
            param_count=len(self._names), param_index=index,
        )  # fmt: skip
        self._send(kind, payload)

    def read(self, m: Any) -> None:
        """PARAM_REQUEST_READ: by number, or by name when that is negative."""
        name = m.param_id.decode("ascii", "replace")
        if 0 <= m.param_index < len(self._names):
            self._report(self._names[m.param_index], m.param_index)
        elif m.param_index < 0 and name in self._names:
            self._report(name, _BY_NAME)

    def list(self) -> None:
        """PARAM_REQUEST_LIST"""
        for index, name in enumerate(self._names):
            self._report(name, index)

    def set(self, m: Any) -> None:
        """PARAM_SET: what the physics takes of it is told."""
        name = m.param_id.decode("ascii", "replace")
        if self._plant.set_parameter(name, float(m.param_value)) is not None:
            self._report(name, _BY_NAME)
