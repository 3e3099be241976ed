# SPDX-License-Identifier: BSD-3-Clause
"""The faults that were ordered for one vehicle: those to come and those that have begun, and what parameters they set.

A parameter has the value that it had before the first fault of it, and on top what the faults that have begun say, in
the order in which they began. So it does not matter in which order faults end.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from numbers import Integral
from typing import NamedTuple

from ..autopilot.params.table import Table
from ..core.constants import NEVER
from ..errors import OptionError
from .faults import PARAMETERS, Failure, Text, known, unit_name

ONE_SHOT = ("SIM_SHOVE_TIME", "SIM_TWIST_TIME")
"""The vehicle takes these when they are set, and they are 0 again."""


class Ordered(NamedTuple):
    """A fault that was ordered and is not over."""

    fault: str
    """Text of a checked ``Failure``."""
    begin_us: int
    end_us: int = NEVER
    has_begun: bool = False
    released: tuple[str, ...] = ()
    """Parameters that somebody else has set since it began: it sets them no more."""
    over: tuple[int, ...] = ()
    """Instances that were repaired."""

    def failures(self, table: Table) -> list[Failure]:
        """What fails: the failure, or those of its instances that are not over."""
        failure = Failure.of_text(self.fault)
        return [replace(failure, instance=n) for n in self.left(table)] if self.over else [failure]

    def left(self, table: Table) -> list[int]:
        """Its instances that are not over."""
        return [n for n in Failure.of_text(self.fault).numbers(table) if n not in self.over]


class Repair(NamedTuple):
    """Which faults are over: those of a unit, or one."""

    unit: str = ""
    """Of the table, or a parameter; "": all."""
    instance: int = 0
    type: str = ""
    fault: str = ""
    """Text of the one fault that is over; "": all of the unit."""

    @classmethod
    def of(cls, what: object, instance: object, table: Table) -> Repair:
        """``UNIT[:INSTANCE][/TYPE]``, "" for all, or the text of a fault with its amount or time.

        Raises:
            OptionError: it is none, or the vehicle has no such unit, type or instance.
        """
        if not isinstance(what, str):
            raise OptionError(f"repair of {what!r}: a text such as gps, motor:2 or gps/wrong is needed; '' is all")
        if not isinstance(instance, Integral) or isinstance(instance, bool) or (instance and not what):
            raise OptionError(f"repair of {what!r}: {instance!r} is not the number of an instance; 0 is all")
        found = cls(instance=int(instance))
        if not what:
            return found
        text = Text.of(what)
        if text.instance and instance:
            raise OptionError(f"repair of {what!r}: the instance is given twice, {text.instance} and {instance}")
        if text.amount is not None or text.begin is not None:
            return cls(fault=str(Failure.of_text(what).checked(table)))
        found = cls(unit_name(text.unit), text.instance or int(instance), text.type)
        found._check(table)
        return found

    @property
    def is_parameter(self) -> bool:
        """Whether its unit is a SIM_ parameter."""
        return self.unit.startswith(PARAMETERS)

    def _check(self, table: Table) -> None:
        if self.is_parameter and self.unit in table:
            if self.instance or self.type:
                raise OptionError(f"repair of {self.unit}: a parameter has neither instances nor types")
            return
        types = known(table).get(self.unit)
        if types is None:
            raise OptionError(f"there is no fault {self.unit!r}; there are {', '.join(known(table))}")
        if self.type and self.type not in types:
            raise OptionError(f"fault {self.unit} has no type {self.type!r}; it has {', '.join(types)}")
        most = max(effect.instances for kind, effect in types.items() if self.type in ("", kind))
        if not 0 <= self.instance <= most:
            raise OptionError(
                f"fault {self.unit}: there is no number {self.instance}; it has 1 to {most}, and 0 for all"
            )

    def __str__(self) -> str:
        instance, kind = f":{self.instance}" if self.instance else "", f"/{self.type}" if self.type else ""
        return self.fault or f"{self.unit}{instance}{kind}"

    def remains(self, order: Ordered, table: Table) -> Ordered | None:
        """What is left of a fault that was ordered; None: nothing."""
        failure, left = Failure.of_text(order.fault), order.left(table)
        if not self._concerns(failure, table) or (self.instance and self.instance not in left):
            return order
        return order._replace(over=(*order.over, self.instance)) if self.instance and len(left) > 1 else None

    def _concerns(self, failure: Failure, table: Table) -> bool:
        if not self.unit:
            return True
        if self.is_parameter:
            return self.unit in failure.values(table, {})
        if failure.is_parameter:  # of the unit as a whole
            effects = known(table)[self.unit].values()
            names = {name for effect in effects if self.type in ("", effect.type) for name in effect.names()}
            return not self.instance and failure.unit in names
        same = known(table)[self.unit].get(failure.type)  # motor and servo may be the same thing
        sets_the_same = same is not None and not failure.values(table, {}).keys().isdisjoint(same.names())
        return self.type in ("", failure.type) and (self.unit == failure.unit or sets_the_same)


class OrderedFaults:
    """The faults of one vehicle.

    Args:
        table: its parameters.
    """

    def __init__(self, table: Table) -> None:
        self._table = table
        self.orders: tuple[Ordered, ...] = ()
        """As they were ordered."""
        self.before: dict[str, float] = {}
        """Values of parameters before the first fault that sets them now."""

    @property
    def due_us(self) -> int:
        """When the next one begins or ends."""
        return min((o.end_us if o.has_begun else o.begin_us for o in self.orders), default=NEVER)

    def order(self, failure: Failure, now_us: int) -> Ordered:
        """Let something fail; its times count from now.

        Raises:
            OptionError: the vehicle has no such fault.
        """
        failure = failure.checked(self._table)
        end_us = NEVER if failure.end is None else now_us + round(1e6 * failure.end)
        order = Ordered(str(failure), now_us + round(1e6 * failure.begin), end_us)
        self.orders = (*self.orders, order)
        return order

    def repair(self, repair: Repair) -> None:
        """These are over, and those to come do not begin; of the same fault ordered twice the later one is over."""
        if repair.fault:
            same = [o for o in self.orders if o.fault == repair.fault]
            over = max(same, key=lambda o: (o.has_begun, o.begin_us), default=None)
            self.orders = tuple(o for o in self.orders if o is not over)
            return
        remain = [repair.remains(order, self._table) for order in self.orders]
        self.orders = tuple(order for order in remain if order is not None)

    def was_set(self, name: str) -> None:
        """Somebody else has set a parameter: it is no concern of the faults that have begun any more."""
        if self.before.pop(name, None) is not None:
            self.orders = tuple(o._replace(released=(*o.released, name)) if o.has_begun else o for o in self.orders)

    def values(self, now_us: int, present: Callable[[str], float]) -> dict[str, float]:
        """Let faults begin and end that are due; gives the values that parameters have from now on.

        Args:
            now_us: on the clock of ``order``.
            present: value of a parameter.
        """
        once: dict[str, float] = {}
        orders = []
        for o in self.orders:
            if o.end_us <= now_us:
                continue
            if not o.has_begun and o.begin_us <= now_us:
                values = {name: x for f in o.failures(self._table) for name, x in f.values(self._table, {}).items()}
                once |= {name: value for name, value in values.items() if name in ONE_SHOT}
                for name in values.keys() - once.keys() - self.before.keys():
                    self.before[name] = present(name)
                o = o._replace(has_begun=True, released=tuple(once.keys() & values.keys()))
            orders.append(o)
        self.orders = tuple(orders)
        wanted, are_set = dict(sorted(self.before.items())), set[str]()
        for o in sorted((o for o in orders if o.has_begun), key=lambda o: o.begin_us):
            for failure in o.failures(self._table):
                for name, value in failure.values(self._table, wanted).items():
                    if name not in o.released:
                        wanted[name] = value
                        are_set.add(name)
        self.before = {name: value for name, value in self.before.items() if name in are_set}
        return wanted | once
