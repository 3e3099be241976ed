# SPDX-License-Identifier: BSD-3-Clause
"""Parameters over MAVLink: read, set, and set for a while."""

from __future__ import annotations

import contextlib
import difflib
import math
from collections.abc import Callable, ItemsView, Iterator, Mapping, ValuesView
from numbers import Real
from typing import Any

from ..autopilot.params.table import Values
from ..errors import OptionError
from . import px4
from .errors import ClientError, ParameterRefusedError, UnknownNameError, WaitTimeoutError
from .session import ANSWER_S, REPEAT_US, Session

__tracebackhide__ = True

REAL_32 = 9
"""MAV_PARAM_TYPE_REAL32"""
LIST_S = 30.0
"""One more parameter of the list is there within."""
AT_ONCE = 50
"""As many of those that are missing are asked for together."""
EVERY = 1 << 16
"""No list is longer."""


class Parameters(Mapping[str, float]):
    """The parameters of a vehicle: ``vehicle.params["WPNAV_SPEED"] = 500`` sets one, and sees that it took it.

    Values are asked for each time; values are in ArduPilot's own units. As a mapping it has the names that the vehicle
    lists; ``in`` and ``get`` know those that it keeps to itself while they have no effect, too.
    """

    def __init__(self, session: Session) -> None:
        self._session = session

    @property
    def _values(self) -> Values | None:
        """Those of a vehicle in this process."""
        simulation = self._session.connection.simulation
        return None if simulation is None else simulation.parameters

    def __getitem__(self, name: str) -> float:
        """Ask the vehicle for a parameter's present value.

        Raises:
            UnknownNameError: there is no such parameter (known only of vehicles in this process).
            WaitTimeoutError: no answer.
        """
        self.check(name)
        return self._exchange(name, f"the value of {name}", "PARAM_REQUEST_READ", param_index=-1)

    def __setitem__(self, name: str, value: float) -> None:
        """Set a parameter, and see that the vehicle took it.

        Raises:
            ParameterRefusedError: the vehicle keeps another value.
            OptionError: the value is no number.
            UnknownNameError, WaitTimeoutError: as for reading.
        """
        self.check(name)
        _check_number(name, value)
        what = f"{name} to be set to {value:g}"
        session, sent, kind = self._session, value, REAL_32
        if session.telemetry.is_px4:  # it takes a value in the parameter's own type only
            if name not in session.telemetry.parameter_types:
                self._exchange(name, f"the type of {name}", "PARAM_REQUEST_READ", param_index=-1)
            kind = session.telemetry.parameter_types[name]
            sent = px4.encoded(name, value, kind)
        for _ in range(2):  # the first answer may be to what was asked before, come late
            kept = self._exchange(name, what, "PARAM_SET", param_value=sent, param_type=kind)
            is_taken: Callable[[], bool] = lambda: math.isclose(  # noqa: E731
                self._session.telemetry.parameters[name], value, rel_tol=1e-6, abs_tol=1e-9
            )
            if self._session.passes(is_taken, REPEAT_US / 1e6):
                return
        self._session.raise_error(ParameterRefusedError(name, value, kept))

    def __contains__(self, name: object) -> bool:
        """Whether the vehicle has a parameter; one that is elsewhere is asked, and says no by not answering."""
        values = self._values
        if values is not None:
            return name in values.table
        return isinstance(name, str) and self.get(name) is not None

    def get(self, name: str, default: Any = None) -> Any:  # type: ignore[override]
        """A parameter's present value; ``default``: the vehicle has no such parameter."""
        session = self._session
        values = self._values
        if values is not None:
            return self[name] if name in values.table else default
        refused: list[Any]
        with session.messages("PARAM_ERROR") as refused:
            return self._ask(name, lambda: any(_named(m) == name for m in refused), default)

    def __iter__(self) -> Iterator[str]:
        values = self._values
        if values is not None:
            return iter([parameter.name for parameter in values.listed()])
        return iter(self.read_all())

    def __len__(self) -> int:
        return sum(1 for _ in self)

    def items(self) -> ItemsView[str, float]:
        """All with their values, read together (``read_all``)."""
        return self.read_all().items()

    def values(self) -> ValuesView[float]:
        """All values, read together (``read_all``)."""
        return self.read_all().values()

    def update(self, values: Mapping[str, float] | None = None, **more: float) -> None:
        """Set several, each in its unit; all names are checked first."""
        given = {**(values or {}), **more}
        for name, value in given.items():
            self.check(name)
            _check_number(name, value)
        for name, value in given.items():
            self[name] = value

    @contextlib.contextmanager
    def changed(self, values: Mapping[str, float] | None = None, **more: float) -> Iterator[None]:
        """``with vehicle.params.changed(ANGLE_MAX=2000):`` sets parameters, and sets them back afterwards."""
        given = {**(values or {}), **more}
        for name, value in given.items():
            self.check(name)
            _check_number(name, value)
        before: dict[str, float] = {}
        for name, value in given.items():
            before[name] = self[name]
            self[name] = value
        try:
            yield
        except BaseException:
            with contextlib.suppress(ClientError, AssertionError):  # the block's own failure counts
                self.update(before)
            raise
        self.update(before)

    def read_all(self) -> dict[str, float]:
        """All parameters by name; those that get lost on the way are asked for again.

        Raises:
            WaitTimeoutError: for ``LIST_S`` none came that was missing.
        """
        session = self._session
        found: dict[int, Any] = {}

        def missing() -> list[int] | None:
            return [k for k in range(next(iter(found.values())).param_count) if k not in found] if found else None

        def ask(which: list[int] | None) -> int:
            if which is None:
                session.send("PARAM_REQUEST_LIST")
                return EVERY
            for index in which[:AT_ONCE]:
                session.send("PARAM_REQUEST_READ", param_index=index)
            return min(len(which), AT_ONCE)

        def take(m: Any) -> None:
            if m.param_index < m.param_count:
                found[m.param_index] = m

        session.collect("PARAM_VALUE", missing, ask, take, "all parameters", LIST_S)
        value: Callable[[Any], float] = px4.value_of if session.telemetry.is_px4 else lambda v: float(v.param_value)
        return {v.param_id.decode("ascii", "replace"): value(v) for _, v in sorted(found.items())}

    def check(self, name: str) -> None:
        """Raise UnknownNameError when the vehicle, in this process, has no such parameter."""
        values = self._values
        if isinstance(name, str) and (values is None or name in values.table):
            return
        if not isinstance(name, str) or values is None:
            raise UnknownNameError(f"the {self._session.kind} has no parameter {name!r}: a name is a text")
        near = difflib.get_close_matches(name, values.table.names(), 5, 0.5)
        hint = f"; near to it: {', '.join(near)}" if near else ""
        raise UnknownNameError(f"the {self._session.kind} has no parameter {name!r}{hint}")

    def _ask(self, name: str, is_refused: Callable[[], bool], default: Any) -> Any:
        """Ask for a parameter until its value or a refusal comes; ``default``: it does not have it."""
        values = self._session.telemetry.parameters
        values.pop(name, None)
        for _ in range(round(ANSWER_S * 1e6 / REPEAT_US)):
            self._session.send("PARAM_REQUEST_READ", param_id=name.encode(), param_index=-1)
            if self._session.passes(lambda: name in values or is_refused(), REPEAT_US / 1e6):
                break
        return values.get(name, default)

    def _exchange(self, name: str, what: str, message: str, **fields: Any) -> float:
        """Send a message until the parameter's value comes."""
        session, values = self._session, self._session.telemetry.parameters
        values.pop(name, None)
        begin = session.now
        arrived: Callable[[], bool] = lambda: name in values  # noqa: E731
        for _ in range(round(ANSWER_S * 1e6 / REPEAT_US)):
            session.send(message, param_id=name.encode(), **fields)
            if session.passes(arrived, REPEAT_US / 1e6):
                return values[name]
        session.raise_error(WaitTimeoutError(what, ANSWER_S, "", begin))


def _check_number(name: str, value: Any) -> None:
    if not isinstance(value, Real):
        raise OptionError(f"{name} = {value!r}; a parameter's value is a number")


def _named(m: Any) -> str:
    """Name of the parameter that a message is about."""
    return str(m.param_id.decode("ascii", "replace"))
