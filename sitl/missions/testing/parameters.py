# SPDX-License-Identifier: BSD-3-Clause
"""Parameters over MAVLink: read, set, and set for a while."""

from __future__ import annotations

import difflib
from collections.abc import Mapping
from types import TracebackType

import numpy as np

from .connected import ANSWER_S, Connected


class UnknownName(ValueError):
    """A parameter, mode, channel or fault that this vehicle does not have; says which there are."""


class Tunable(Connected):
    """A vehicle whose parameters can be set."""

    def _known(self, name: str) -> str:
        __tracebackhide__ = True
        names = [parameter.name for parameter in self.simulation.firmware.table]
        if name not in names:
            near = difflib.get_close_matches(name, names, 5, 0.5)
            hint = f"; near to it: {', '.join(near)}" if near else ""
            raise UnknownName(f"the {self.kind} has no parameter {name!r}{hint}")
        return name

    def parameter(self, name: str) -> float:
        """Ask the vehicle for a parameter's present value."""
        __tracebackhide__ = True
        self._known(name)
        self.telemetry.parameters.pop(name, None)
        self.send("PARAM_REQUEST_READ", param_id=name.encode(), param_index=-1)
        self.wait_until(lambda: name in self.telemetry.parameters, ANSWER_S, f"the value of {name}")
        return self.telemetry.parameters[name]

    def set_parameter(self, name: str, value: float) -> None:
        """Set a parameter, and see that the vehicle took it."""
        __tracebackhide__ = True
        self._known(name)
        self.telemetry.parameters.pop(name, None)
        self.send("PARAM_SET", param_id=name.encode(), param_value=value, param_type=9)
        self.wait_until(lambda: name in self.telemetry.parameters, ANSWER_S, f"{name} to be set to {value:g}")
        got = self.telemetry.parameters[name]
        if not np.isclose(got, value, rtol=1e-6, atol=1e-9):
            self.give_up(f"{name} was not set to {value:g}: it is {got:g}")

    def set_parameters(self, values: Mapping[str, float] | None = None, **more: float) -> None:
        """Set several."""
        __tracebackhide__ = True
        given = {**(values or {}), **more}
        for name in given:
            self._known(name)
        for name, value in given.items():
            self.set_parameter(name, value)

    def parameters(self, values: Mapping[str, float] | None = None, **more: float) -> Lent:
        """``with copter.parameters(ANGLE_MAX=2000):`` sets parameters, and sets them back when the block is left."""
        __tracebackhide__ = True
        given = {**(values or {}), **more}
        for name in given:
            self._known(name)
        return Lent(self, given)


class Lent:
    """Parameters for the time of a block."""

    def __init__(self, vehicle: Tunable, values: Mapping[str, float]) -> None:
        self._vehicle, self._values = vehicle, values
        self._before: dict[str, float] = {}

    def __enter__(self) -> None:
        __tracebackhide__ = True
        for name, value in self._values.items():
            self._before[name] = self._vehicle.parameter(name)
            self._vehicle.set_parameter(name, value)

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        __tracebackhide__ = True
        try:
            self._vehicle.set_parameters(self._before)
        except AssertionError:
            if error is None:  # the block's own failure counts
                raise
