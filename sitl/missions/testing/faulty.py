# SPDX-License-Identifier: BSD-3-Clause
"""A vehicle in a test that can fail. A fault that never acted fails the test at its end."""

from __future__ import annotations

import re
from collections.abc import Callable, Iterable, Sequence
from types import TracebackType
from typing import Any

from sitl.bridge.links import LinkFaults
from sitl.bridge.services.failure_injection import FaultService
from sitl.client.connection import Connection
from sitl.errors import OptionError
from sitl.simulation import Simulation
from sitl.vehicle.equipment import Equipment
from sitl.vehicle.fault_history import Acted
from sitl.vehicle.faults import Failure, Text, unit_name

from .moments import Forking

__tracebackhide__ = True

STATION, LINK, WIND = "station", "link", "wind"
OF_CLIENTS = (STATION, LINK)
"""Faults that are not of the vehicle."""


class Fault:
    """A fault that lasts until ``repair``, or until the end of a ``with`` block.

    Args:
        end: repairs it.
        parts: what is known of it: of a wind, one each of its speed, direction and turbulence.
        may_not_act: the test does not fail when it never acts.
    """

    def __init__(self, end: Callable[[], None], parts: Sequence[Acted], may_not_act: bool) -> None:
        self._end, self._parts, self.may_not_act = end, parts, may_not_act

    @property
    def acted(self) -> Acted:
        """When it acted: of its parts, the first that did."""
        return next((part for part in self._parts if part.spans), self._parts[0])

    def repair(self) -> None:
        """All is as before."""
        self._end()

    def __enter__(self) -> Fault:
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        if error is None:
            self.repair()


class Faulty(Forking):
    """A vehicle that can fail."""

    def __init__(self, build: Callable[[], Simulation | Connection], name: str = "vehicle") -> None:
        self.failures: list[Fault] = []
        """What the test let fail, in order."""
        self._of_client: dict[str, Acted] = {}
        """Faults of the client, and those of another autopilot, that are in force; ``begin_us`` is since when."""
        super().__init__(build, name)

    def fail(self, what: str, type: str = "", *, instance: int = 0, amount: float | None = None, at: float = 0.0,
             until: float | None = None, motor: int | None = None, thrust: float | None = None,
             speed: float | None = None, direction: float | None = None, turbulence: float | None = None,
             faults: LinkFaults | None = None, may_not_act: bool = False) -> Fault:  # fmt: skip
        """Let something fail, until ``restore(what)``, ``.repair()`` of what this gives, or for a ``with`` block.

        The test fails if the fault never acts: it begins after the end, on a vehicle that is not armed, on a sensor
        that is switched off, or sets what was set before.

        Args:
            what: a unit or a ``SIM_`` parameter of docs/faults.md ("gps", "motor", "SIM_WIND_SPD"), or a whole fault as
                --fail takes it ("motor:2=0.5@20..30"); "station": no heartbeat of this ground station any more, and
                "link": the link to it has ``faults`` (None: it is cut).
            type: how, as "off"; "": the unit's first type.
            instance: which one, from 1; 0: all.
            amount: how much; None: the usual amount.
            at, until: simulated seconds from now; None: it stays.
            motor, thrust: of "motor": other names of instance and amount (the share of its pulse that is left).
            speed, direction, turbulence: of "wind": 10 m/s, from 0 deg (north), 0 m/s when they are not given.
            may_not_act: the test does not fail when the fault never acts.

        Raises:
            OptionError: the vehicle has no such fault, or an argument that has no effect on it is given.
        """
        given = _apart(what, type, instance, amount, at, until)
        unit, type, instance, amount, at, until = given
        own = {"motor": ("motor", motor), "thrust": ("motor", thrust), "speed": (WIND, speed), "faults": (LINK, faults),
               "direction": (WIND, direction), "turbulence": (WIND, turbulence)}  # fmt: skip
        for name, (of, value) in own.items():
            if value is not None and unit != of:
                raise OptionError(f"fault {what!r} takes no {name} (given: {value!r}); {of!r} does")
        if unit in OF_CLIENTS:
            if at or until is not None:
                raise OptionError(f"fault {what!r} is this client's, and begins now: at and until are of the vehicle's")
            if type or instance or amount is not None:
                raise OptionError(f"fault {what!r} is this client's: it has no type, instance or amount")
            return self._keep_fault(self._fail_client(unit, faults), may_not_act, unit)
        for name, first, other, second in (
            ("motor", motor, "instance", instance or None), ("thrust", thrust, "amount", amount),
            ("speed", speed, "amount", amount),
        ):  # fmt: skip
            if first is not None and second is not None:
                raise OptionError(f"fault {what!r}: {name}={first!r} and {other}={second!r} say the same thing")
        share = next((number for number in (thrust, speed, amount) if number is not None), None)
        failures = [Failure(unit, type, instance if motor is None else motor, share, at, until)]
        if unit == WIND:
            parameters = {"SIM_WIND_DIR": direction or 0.0, "SIM_WIND_TURB": turbulence or 0.0}
            failures += [Failure(name, amount=value, begin=at, end=until) for name, value in parameters.items()]
        assert self.connection.kind is not None
        table = self.connection.kind.firmware.table
        texts = [str(failure.checked(table)) for failure in failures]
        fault = Fault(lambda: self._repair(texts), [self._let_fail(text) for text in texts], may_not_act)
        self.failures.append(fault)
        return fault

    def judge_faults(self) -> list[str]:
        """Which faults have acted, from when to when, for a report: a line for each."""
        now_us = self.connection.time_us
        history = self._fault_history()
        if history is not None:
            history.finish(now_us)
        for acted in self._of_client.values():
            _close(acted, now_us)
        return [str(fault.acted) for fault in self.failures]

    @property
    def idle_faults(self) -> list[str]:
        """Why those that must have acted have not until now."""
        self.judge_faults()
        return [str(fault.acted) for fault in self.failures if not fault.acted.spans and not fault.may_not_act]

    # ------------------------------------------------------------------ how they act

    def _fault_history(self) -> Any:
        simulation = self.connection.simulation
        return None if simulation is None else simulation.bridge.get(FaultService).keep_history()

    def _let_fail(self, text: str) -> Acted:
        history = self._fault_history()
        if history is None:
            plant: Any = self.connection.plant  # type: ignore[attr-defined]
            Equipment(self.connection.kind, plant.vehicle.airframe).check(Failure.of_text(text))  # type: ignore[arg-type]
            self.order_fault(text)
            return self._fault_begins(text)
        count = len(history.faults)
        try:
            self.order_fault(text)
        except OptionError as error:  # in the line of the test
            raise OptionError(str(error)) from None
        return history.faults[count]  # type: ignore[no-any-return]

    def _fault_begins(self, what: str) -> Acted:
        """A fault that is not in the vehicle's history begins now."""
        acted = self._of_client[what] = Acted(what, self.connection.time_us, why="no simulated time went by")
        return acted

    def _fail_client(self, unit: str, faults: LinkFaults | None) -> Acted:
        if unit == STATION:
            self.heartbeats(False)
            return self._fault_begins(unit)
        wanted = faults if faults is not None else LinkFaults(loss=1.0)
        self.set_link_faults(wanted)
        acted = self._fault_begins(unit)
        if wanted.does_nothing:
            self._of_client.pop(unit)
            acted.why = "its LinkFaults do nothing"
        return acted

    def _keep_fault(self, acted: Acted, may_not_act: bool, unit: str) -> Fault:
        fault = Fault(lambda: self.restore(unit), [acted], may_not_act)
        self.failures.append(fault)
        return fault

    def _repair(self, texts: Iterable[str]) -> None:
        for text in texts:
            self.order_fault(f"-{text}")
            self._fault_ends(text)

    def _fault_ends(self, what: str) -> None:
        acted = self._of_client.pop(what, None)
        if acted is not None:
            _close(acted, self.connection.time_us)

    def restore(self, moment: Any) -> None:
        """Put the vehicle back to a moment of ``snapshot()``, or end faults: "gps", "motor:2", "gps/wrong"; "": all."""
        if not isinstance(moment, str):
            for acted in self._of_client.values():
                _close(acted, self.connection.time_us)
            super().restore(moment)
            for acted in self._of_client.values():
                acted.begin_us = self.connection.time_us
        elif moment == STATION:
            self.heartbeats(True)
            self._fault_ends(STATION)
        elif moment == LINK:
            self.set_link_faults(None)
            self._fault_ends(LINK)
        else:
            self._repair((moment, "SIM_WIND_DIR", "SIM_WIND_TURB") if moment == WIND else (moment,))


def _apart(
    what: str, type: str, instance: int, amount: float | None, at: float, until: float | None
) -> tuple[str, str, int, float | None, float, float | None]:
    """A fault as ``fail`` takes it, a text such as "motor:2=0.5@20..30" taken apart.

    Raises:
        OptionError: the text is no fault, or says what an argument says, too.
    """
    if not (isinstance(what, str) and re.search("[:/=@]", what)):
        return unit_name(what) if isinstance(what, str) else what, type, instance, amount, at, until
    text = Text.of(what)
    for name, there, other in (
        ("type", text.type, type), ("instance", text.instance, instance), ("amount", text.amount, amount),
        ("at", text.begin, at), ("until", text.end, until),
    ):  # fmt: skip
        if there not in (None, "", 0) and other not in (None, "", 0):
            raise OptionError(f"fault {what!r}: {name} is given twice, {there!r} and {other!r}")
    return (
        unit_name(text.unit), text.type or type, text.instance or instance,
        amount if text.amount is None else text.amount, at if text.begin is None else text.begin,
        until if text.end is None else text.end,
    )  # fmt: skip


def _close(acted: Acted, now_us: int) -> None:
    """It acted until now, and goes on from here."""
    if now_us > acted.begin_us:
        acted.spans.append((acted.begin_us, now_us))
        acted.begin_us = now_us
