# SPDX-License-Identifier: BSD-3-Clause
"""Faults on demand: they set SIM_ parameters at their simulated times, and set them back."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from ...autopilot.params.parameter import stored
from ...autopilot.shell_parameters import FAILURES
from ...core.constants import NEVER
from ...core.mavlink import MavResult
from ...errors import OptionError
from ...vehicle.acting import ARMED
from ...vehicle.equipment import Equipment
from ...vehicle.fault_history import Acted, FaultHistory, Key, changes_nothing
from ...vehicle.faults import TYPES, UNITS, Failure, known
from ...vehicle.ordered_faults import ONE_SHOT, Ordered, OrderedFaults, Repair
from ..host import Host
from .parameter_protocol import ParameterService
from .service import Service

STUCK = "SIM_RC_STUCK"
LOOK_US = 100_000
"""How often is looked whether channels that are to stay as they are are transmitted."""


class FaultService(Service):
    """What fails, and when."""

    def __init__(self, bridge: Host) -> None:
        super().__init__(bridge)
        self._table = bridge.vehicle.firmware.table
        self._faults = OrderedFaults(self._table)
        self.is_setting = False
        """Whether the parameter that is set now is set by a fault."""
        self._just_set = ""
        """The parameter that a client has just set."""
        self.history: FaultHistory | None = None
        """Which faults have acted; None: nobody wants to know."""

    @property
    def texts(self) -> list[str]:
        """Those that were ordered and are not over, as they were ordered."""
        return [str(failure) for order in self._faults.orders for failure in order.failures(self._table)]

    def check(self, failure: Failure) -> None:
        """OptionError when the vehicle has no such fault, nothing of what fails, or it does nothing to its physics."""
        vehicle: Any = self.bridge.vehicle
        table = self._table
        failure = failure.checked(table)
        self.equipment.check(failure, self._without_faults)
        names, idle = failure.values(table, {}), vehicle.plant.idle_parameters
        without = [name for name in names if name.startswith(idle)] if idle else []
        if without and (failure.instance or len(without) == len(names)):  # of all instances some may do nothing
            works = [unit for unit, types in known(table).items() for effect in types.values()
                     if not effect.names()[0].startswith(idle)]  # fmt: skip
            there_are = ", ".join(dict.fromkeys(works))
            raise OptionError(
                f"fault {failure.unit}: {without[0]} does nothing to physics {vehicle.physics}; there are {there_are}"
            )

    @property
    def equipment(self) -> Equipment:
        """What the vehicle has of all that can fail."""
        vehicle: Any = self.bridge.vehicle
        return Equipment(vehicle.kind, vehicle.airframe, vehicle.world is not None, ":" in vehicle.physics)

    def _without_faults(self, name: str) -> float:
        """A parameter as it is without faults."""
        before = self._faults.before.get(name)
        return self.bridge.vehicle.parameters[name] if before is None else before

    def repair_of(self, what: object, instance: object = 0) -> Repair:
        """What is to be repaired, checked.

        Raises:
            OptionError: there is no such unit, type or instance.
        """
        return Repair.of(what, instance, self._table)

    def fail(self, failure: Failure) -> Acted | None:
        """Let something fail now or later; gives what will be known of it if somebody wants to know.

        Raises:
            OptionError: as of ``check``.
        """
        self.check(failure)
        order = self._faults.order(failure, self.bridge.elapsed_us)
        acted = self._note(order) if self.history is not None else None
        self.service(self.bridge.now_us)
        return acted

    def keep_history(self) -> FaultHistory:
        """Take down from now on which faults act, and when."""
        if self.history is None:
            self.history = FaultHistory()
            for order in self._faults.orders:
                self._note(order)
            self.look()
        return self.history

    def _note(self, order: Ordered) -> Acted:
        assert self.history is not None
        values = Failure.of_text(order.fault).values(self._table, {})
        lasts = [1000 * int(values[name]) for name in ONE_SHOT if name in values]
        return self.history.ordered(order, max(lasts, default=NEVER))

    def look(self) -> None:
        """Something has changed that faults may depend on."""
        if self.history is not None:
            self.history.look(self.bridge.elapsed_us, dict(map(self._state, self._begun())))

    def _begun(self) -> list[Ordered]:
        return [order for order in self._faults.orders if order.has_begun]

    def _state(self, order: Ordered) -> tuple[Key, str]:
        """A fault that has begun, and why it does not act; "": it does."""
        vehicle: Any = self.bridge.vehicle
        table, why = self._table, ""
        for failure in order.failures(table):
            values = {name: stored(table[name], x) for name, x in failure.values(table, self._faults.before).items()}
            left = {name: x for name, x in values.items() if name not in order.released or name in ONE_SHOT}
            why = f"a client set {next(iter(values))} meanwhile"
            if left:
                before = {name: self._seen(name, self._without_faults(name)) for name in left}
                now = {name: self._seen(name, value) for name, value in left.items()}
                why = changes_nothing(failure, now, before, self._present) or self._not_transmitted(now, before)
            if not why and failure.drives_outputs and not vehicle.v.autopilot.arming.armed:
                why = "the vehicle was not armed"
            try:
                self.equipment.check(failure, self._without_faults)
            except OptionError as error:
                why = why or str(error).partition(": ")[2]
            if not why:
                break
        return (order.fault, order.begin_us), why

    def _seen(self, name: str, value: float) -> float:
        """What the vehicle takes of a parameter's value: of a mask, the bits of what it has."""
        bits = self.equipment.bits(name)
        return value if bits is None else float(int(value) & bits)

    def _present(self, name: str) -> float | None:
        """A parameter that is in force; one that is 0 again as soon as it was taken as it was set."""
        vehicle: Any = self.bridge.vehicle
        if name == ARMED:
            return float(vehicle.v.autopilot.arming.armed)
        if name not in self._table:
            return None
        if name in ONE_SHOT:
            if name == self._just_set:
                return 1.0
            set_by = (failure.values(self._table, {}).get(name, 0.0)
                      for order in self._begun() for failure in order.failures(self._table))  # fmt: skip
            return max(set_by, default=0.0)
        return self._seen(name, vehicle.parameters[name])

    def _not_transmitted(self, values: Mapping[str, float], before: Mapping[str, float]) -> str:
        """Why channels that are to stay as they are do nothing; "": one of them is transmitted."""
        if values.keys() != {STUCK}:
            return ""
        rc: Any = self.bridge.vehicle.v.autopilot.rc
        sent = [k + 1 for k in range(len(rc.channels)) if rc.channels[k] != 0 or rc.override[k] != 0]
        stay = int(values[STUCK]) ^ int(before[STUCK])
        if not sent or any(stay >> (k - 1) & 1 for k in sent):
            return ""
        which = ", ".join(str(k + 1) for k in range(len(rc.channels)) if stay >> k & 1)
        return f"channel {which} is not transmitted; there are {', '.join(map(str, sent))}"

    def repair(self, repair: Repair) -> None:
        """Faults are over: parameters are what they would be without them, and none of them begins later."""
        self._faults.repair(repair)
        self._set_parameters()

    def service(self, now_us: int) -> None:
        if self._faults.due_us <= self.bridge.elapsed_us:
            self._set_parameters()
        self._look()

    def _sets(self, order: Ordered) -> set[str]:
        return {name for failure in order.failures(self._table) for name in failure.values(self._table, {})}

    def _set_parameters(self) -> None:
        present, table = self.bridge.vehicle.parameters, self._table
        self.is_setting = True
        try:
            for name, value in self._faults.values(self.bridge.elapsed_us, present.__getitem__).items():
                if present[name] != stored(table[name], value):
                    self.bridge.get(ParameterService).set(name, value)
        finally:
            self.is_setting = False
        self._look()

    def _look(self) -> None:
        self.look()
        due_us = self._faults.due_us
        if self.history is not None and any(STUCK in self._sets(order) for order in self._begun()):
            due_us = min(due_us, self.bridge.elapsed_us + LOOK_US)  # a client may begin to transmit a channel
        self.due_us = NEVER if due_us >= NEVER else due_us - (self.bridge.elapsed_us - self.bridge.now_us)

    def arming_changed(self) -> None:
        self.look()

    def parameter_changed(self, name: str) -> None:
        if not self.is_setting:
            self._faults.was_set(name)
            self._just_set = name
            self.look()
            self._just_set = ""

    def command(self, unit: float, kind: float, instance: float) -> int:
        """MAV_CMD_INJECT_FAILURE; gives the MAV_RESULT."""
        if self.bridge.vehicle.parameters[FAILURES] == 0.0:
            return MavResult.UNSUPPORTED
        units = known(self._table)
        name = next((name for name, number in UNITS.items() if number == unit and name in units), None)
        if name is None or kind not in range(len(TYPES)):
            return MavResult.UNSUPPORTED
        types = units[name]
        if kind != 0.0 and TYPES[int(kind)] not in types:
            return MavResult.UNSUPPORTED
        meant = types.values() if kind == 0.0 else (types[TYPES[int(kind)]],)
        most = max(effect.instances for effect in meant)
        if instance not in (0, *self.equipment.numbers(name, most)):
            return MavResult.DENIED
        if kind == 0.0:
            self.repair(self.repair_of(name, int(instance)))
        else:
            try:
                self.fail(Failure(name, TYPES[int(kind)], int(instance)))
            except OptionError:  # not with this physics, or not on this vehicle
                return MavResult.UNSUPPORTED
        return MavResult.ACCEPTED

    def follow(self, before: FaultService) -> None:
        """Go on after a reboot."""
        self._faults, self.history = before._faults, before.history
        self._look()

    def snapshot(self) -> Any:
        return tuple(map(tuple, self._faults.orders)), tuple(self._faults.before.items())

    def restore(self, state: Any) -> None:
        orders, before = state
        self._faults.orders, self._faults.before = tuple(Ordered(*order) for order in orders), dict(before)
        self._look()
