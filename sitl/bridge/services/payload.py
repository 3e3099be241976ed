# SPDX-License-Identifier: BSD-3-Clause
"""What the services of gripper, winch, sprayer and mount share: outputs by their function."""

from __future__ import annotations

from ...autopilot.payload import OUTPUTS
from ..host import Host
from .service import StatefulService

SHORTEST, MIDDLE, LONGEST = 1100.0, 1500.0, 1900.0
"""Pulses [us] of outputs that say nothing else."""


class PayloadService(StatefulService):
    """Something that hangs on servo outputs. What it is, parameters say at boot."""

    def __init__(self, bridge: Host) -> None:
        super().__init__(bridge)
        self._values = bridge.vehicle.parameters

    def _value(self, name: str, otherwise: float = 0.0) -> float:
        """A parameter; ``otherwise`` when the firmware has none of this name."""
        return self._values[name] if name in self._values.table else otherwise

    def _outputs(self, function: int) -> list[int]:
        """Outputs, from 1, that have a function."""
        return [n for n in range(1, OUTPUTS + 1) if self._value(f"SERVO{n}_FUNCTION") == function]

    def _send(self, function: int, pulse: float) -> None:
        """A pulse [us] on all outputs of a function; 0 none."""
        for number in self._outputs(function):
            self.bridge.autopilot.set_servo(number, int(pulse))

    def _send_share(self, function: int, share: float) -> None:
        """A pulse between the least (share 0) and the greatest (1) that each output of a function has."""
        for number in self._outputs(function):
            least, most = self._value(f"SERVO{number}_MIN", SHORTEST), self._value(f"SERVO{number}_MAX", LONGEST)
            share_of = 1.0 - share if self._value(f"SERVO{number}_REVERSED") else share
            self.bridge.autopilot.set_servo(number, int(least + min(max(share_of, 0.0), 1.0) * (most - least)))

    def _is_fitted(self, function: int) -> bool:
        return bool(self._outputs(function))
