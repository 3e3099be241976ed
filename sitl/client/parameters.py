# SPDX-License-Identifier: BSD-3-Clause
"""Parameters over MAVLink: read, set, and set for a while."""

from __future__ import annotations

import contextlib
import difflib
import math
from collections.abc import Callable, Iterator, Mapping
from typing import Any

from .errors import ClientError, ParameterRefusedError, UnknownNameError, WaitTimeoutError
from .session import ANSWER_S, REPEAT_US, Session

__tracebackhide__ = True

REAL_32 = 9
"""MAV_PARAM_TYPE_REAL32"""
LIST_S = 30.0
"""One more parameter of the list is there within."""
SILENCE_S = 1.0
"""The list has come to its end, or what is missing of it is lost, when none has come for so long."""
MISSING_AT_ONCE = 50
"""As many of those that are missing are asked for together."""


class Parameters:
    """The parameters of a vehicle: ``vehicle.params["WPNAV_SPEED"] = 500`` sets one, and sees that it took it.

    Values are asked for each time; values are in ArduPilot's own units.
    """

    def __init__(self, session: Session) -> None:
        self._session = session

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
            UnknownNameError, WaitTimeoutError: as for reading.
        """
        self.check(name)
        kept = self._exchange(
            name, f"{name} to be set to {value:g}", "PARAM_SET", param_value=value, param_type=REAL_32
        )
        if not math.isclose(kept, value, rel_tol=1e-6, abs_tol=1e-9):
            self._session.raise_error(ParameterRefusedError(name, value, kept))

    def update(self, values: Mapping[str, float] | None = None, **more: float) -> None:
        """Set several, each in its unit; all names are checked first."""
        given = {**(values or {}), **more}
        for name in given:
            self.check(name)
        for name, value in given.items():
            self[name] = value

    @contextlib.contextmanager
    def changed(self, values: Mapping[str, float] | None = None, **more: float) -> Iterator[None]:
        """``with vehicle.params.changed(ANGLE_MAX=2000):`` sets parameters, and sets them back afterwards."""
        given = {**(values or {}), **more}
        for name in given:
            self.check(name)
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
        session, begin = self._session, self._session.now
        found: dict[int, Any] = {}
        with session.messages("PARAM_VALUE") as values:

            def news() -> bool:
                """Take in what has come, if anything has."""
                is_new = bool(values)
                found.update({v.param_index: v for v in values if v.param_index < v.param_count})
                values.clear()
                return is_new

            count, progress = 1, begin
            while len(found) < count:
                missing = [k for k in range(count) if k not in found] if found else []
                for index in missing[:MISSING_AT_ONCE]:
                    session.send("PARAM_REQUEST_READ", param_index=index)
                if not found:
                    session.send("PARAM_REQUEST_LIST")
                before = len(found)
                while len(found) < count and session.passes(news, SILENCE_S):
                    count = next(iter(found.values())).param_count if found else count
                progress = session.now if len(found) > before else progress
                if session.now - progress >= LIST_S:
                    session.raise_error(WaitTimeoutError("all parameters", LIST_S, f"{len(found)} of them", begin))
        return {v.param_id.decode("ascii", "replace"): float(v.param_value) for _, v in sorted(found.items())}

    def check(self, name: str) -> None:
        """Raise UnknownNameError when the vehicle, in this process, has no such parameter."""
        simulation = self._session.connection.simulation
        if simulation is None or name in simulation.firmware.table:
            return
        near = difflib.get_close_matches(name, simulation.firmware.table.names(), 5, 0.5)
        hint = f"; near to it: {', '.join(near)}" if near else ""
        raise UnknownNameError(f"the {self._session.kind} has no parameter {name!r}{hint}")

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
