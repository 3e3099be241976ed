# SPDX-License-Identifier: BSD-3-Clause
"""Faults on demand: they set SIM_ parameters at their simulated times, and set them back."""

from __future__ import annotations

from typing import Any

from ...autopilot.shell_parameters import FAILURES
from ...vehicle.faults import TYPES, UNITS, Failure, known, masks_of, parameters_of
from ..wire.port import NEVER
from .parameters import ParameterService
from .service import ACCEPTED, DENIED, UNSUPPORTED, Service

Order = tuple[int, str, bool]
"""When [us since the start of the simulation], what, and whether it begins then or ends."""


class FaultService(Service):
    """What fails, and when."""

    def __init__(self, bridge: Any) -> None:
        super().__init__(bridge)
        self._table = bridge.vehicle.firmware.table
        self._orders: tuple[Order, ...] = ()
        self._before: dict[str, float] = {}

    def fail(self, failure: Failure) -> None:
        """Let something fail now or later.

        Raises:
            OptionError: the vehicle has no such fault.
        """
        failure, now = failure.checked(self._table), self.bridge.elapsed_us
        orders = [(now + round(1e6 * failure.begin), str(failure), True)]
        if failure.end is not None:
            orders.append((now + round(1e6 * failure.end), str(failure), False))
        self._orders = tuple(sorted((*self._orders, *orders), key=lambda order: order[0]))
        self.service(self.bridge.now_us)

    def repair(self, unit: str = "", instance: int = 0) -> None:
        """All faults of a unit, or of all, are over: its parameters are what they were, and none begins later.

        Args:
            unit: "": all units and parameters.
            instance: 0: all.

        Raises:
            OptionError: there is no such unit.
        """
        names = set(parameters_of(unit, self._table))
        kept = []
        for order in self._orders if unit else ():
            later = Failure.of_text(order[1])
            if not names & later.values(self._table, {}).keys() or instance not in (0, later.instance):
                kept.append(order)
        self._orders = tuple(kept)
        self._look()
        self._repair(names if unit else set(self._before), unit, instance)

    def _repair(self, names: set[str], unit: str, instance: int) -> None:
        values, masks = self.bridge.vehicle.parameters, masks_of(unit, self._table)
        if instance and masks:
            for name in masks:
                left = int(values[name]) & ~(1 << (instance - 1))
                if left:
                    self._set(name, float(left))
                    return
        for name in sorted(names & self._before.keys()):
            self._set(name, self._before.pop(name))

    def _set(self, name: str, value: float) -> None:
        if self.bridge.vehicle.parameters[name] != value:
            self.bridge.get(ParameterService).set(name, value)

    def _look(self) -> None:
        elapsed = self.bridge.elapsed_us - self.bridge.now_us
        self.due_us = self._orders[0][0] - elapsed if self._orders else NEVER

    def service(self, now_us: int) -> None:
        while self._orders and self._orders[0][0] <= self.bridge.elapsed_us:
            (_, text, begins), *rest = self._orders
            self._orders, failure = tuple(rest), Failure.of_text(text)
            values = self.bridge.vehicle.parameters
            wanted = failure.values(self._table, {name: values[name] for name in masks_of(failure.unit, self._table)})
            if not begins:
                self._repair(set(wanted), failure.unit, failure.instance)
                continue
            for name, value in wanted.items():
                self._before.setdefault(name, values[name])
                self._set(name, value)
        self._look()

    def command(self, unit: float, kind: float, instance: float) -> int:
        """MAV_CMD_INJECT_FAILURE; gives the MAV_RESULT."""
        if self.bridge.vehicle.parameters[FAILURES] == 0.0:
            return UNSUPPORTED
        units = known(self._table)
        name = next((name for name, number in UNITS.items() if number == unit and name in units), None)
        if name is None or kind not in range(len(TYPES)):
            return UNSUPPORTED
        types = units[name]
        if kind != 0.0 and TYPES[int(kind)] not in types:
            return UNSUPPORTED
        meant = types.values() if kind == 0.0 else (types[TYPES[int(kind)]],)
        if instance not in range(max(effect.instances for effect in meant) + 1):
            return DENIED
        if kind == 0.0:
            self.repair(name, int(instance))
        else:
            self.fail(Failure(name, TYPES[int(kind)], int(instance)))
        return ACCEPTED

    def follow(self, before: FaultService) -> None:
        """Go on after a reboot."""
        self._orders, self._before = before._orders, before._before
        self._look()

    def snapshot(self) -> Any:
        return self._orders, tuple(self._before.items())

    def restore(self, state: Any) -> None:
        self._orders, self._before = state[0], dict(state[1])
        self._look()
