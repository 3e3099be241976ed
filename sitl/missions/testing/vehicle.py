# SPDX-License-Identifier: BSD-3-Clause
"""A vehicle in a test: ``sitl.client.Client`` under the names of tests, with faults, mission files and goldens."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping
from contextlib import AbstractContextManager
from types import TracebackType
from typing import Any

from sitl.bridge.links import LinkFaults
from sitl.client import Position as Place
from sitl.client import Text
from sitl.client.controls import check_finite
from sitl.errors import OptionError
from sitl.vehicle.faults import Failure

from .golden import Golden
from .missions import MissionFlier
from .moments import Forking

__tracebackhide__ = True

STATION, LINK, WIND = "station", "link", "wind"
OF_CLIENTS = (STATION, LINK)
"""Faults that are not of the vehicle."""


class Fault:
    """A fault that lasts until ``repair``, or until the end of a ``with`` block."""

    def __init__(self, end: Callable[[], None]) -> None:
        self._end = end

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

    def fail(self, what: str, type: str = "", *, instance: int = 0, amount: float | None = None, at: float = 0.0,
             until: float | None = None, motor: int | None = None, thrust: float | None = None,
             speed: float | None = None, direction: float | None = None, turbulence: float | None = None,
             faults: LinkFaults | None = None) -> Fault:  # fmt: skip
        """Let something fail, until ``restore(what)``, ``.repair()`` of what this gives, or for a ``with`` block.

        Args:
            what: a unit or a ``SIM_`` parameter of docs/faults.md ("gps", "motor", "SIM_WIND_SPD"); "station": no
                heartbeat of this ground station any more, and "link": the link to it has ``faults`` (None: it is cut).
            type: how, as "off"; "": the unit's first type.
            instance: which one, from 1; 0: all.
            amount: how much; None: the usual amount.
            at, until: simulated seconds from now; None: it stays.
            motor, thrust: of "motor": other names of instance and amount (the share of its pulse that is left).
            speed, direction, turbulence: of "wind": 10 m/s, from 0 deg (north), 0 m/s when they are not given.

        Raises:
            OptionError: the vehicle has no such fault, or an argument that has no effect on it is given.
        """
        own = {"motor": ("motor", motor), "thrust": ("motor", thrust), "speed": (WIND, speed), "faults": (LINK, faults),
               "direction": (WIND, direction), "turbulence": (WIND, turbulence)}  # fmt: skip
        for name, (unit, value) in own.items():
            if value is not None and what != unit:
                raise OptionError(f"fault {what!r} takes no {name} (given: {value!r}); {unit!r} does")
        if what in OF_CLIENTS:
            if at or until is not None:
                raise OptionError(f"fault {what!r} is this client's, and begins now: at and until are of the vehicle's")
            if type or instance or amount is not None:
                raise OptionError(f"fault {what!r} is this client's: it has no type, instance or amount")
            if what == STATION:
                self.heartbeats(False)
            else:
                self.set_link_faults(faults if faults is not None else LinkFaults(loss=1.0))
            return Fault(lambda: self.restore(what))
        for name, first, other, second in (
            ("motor", motor, "instance", instance or None), ("thrust", thrust, "amount", amount),
            ("speed", speed, "amount", amount),
        ):  # fmt: skip
            if first is not None and second is not None:
                raise OptionError(f"fault {what!r}: {name}={first!r} and {other}={second!r} say the same thing")
        share = next((number for number in (thrust, speed, amount) if number is not None), None)
        failures = [Failure(what, type, instance if motor is None else motor, share, at, until)]
        if what == WIND:
            figures = {"SIM_WIND_DIR": direction or 0.0, "SIM_WIND_TURB": turbulence or 0.0}
            failures += [Failure(name, amount=value, begin=at, end=until) for name, value in figures.items()]
        assert self.connection.kind is not None
        table = self.connection.kind.firmware.table
        texts = [str(failure.checked(table)) for failure in failures]
        for text in texts:
            self.order_fault(text)
        return Fault(lambda: self._repair(texts))

    def _repair(self, texts: Iterable[str]) -> None:
        for text in texts:
            self.order_fault(f"-{text}")

    def restore(self, moment: Any) -> None:
        """Put the vehicle back to a moment of ``snapshot()``, or end faults: "gps", "motor:2", "gps/wrong"; "": all."""
        if not isinstance(moment, str):
            super().restore(moment)
        elif moment == STATION:
            self.heartbeats(True)
        elif moment == LINK:
            self.set_link_faults(None)
        else:
            self._repair((moment, "SIM_WIND_DIR", "SIM_WIND_TURB") if moment == WIND else (moment,))


__all__ = ["Copter", "Place", "Rover", "Text", "Vehicle"]


class Vehicle(Golden, MissionFlier, Faulty):
    """What a test does with a vehicle. Times are simulated seconds, places metres from home, heights above home.

    Whatever is awaited in vain raises an AssertionError that says what was seen last, when, and what the vehicle said.
    """

    @property
    def height(self) -> float:
        """Above home [m]."""
        return self.altitude

    def change_mode(self, name: str, timeout: float = 5.0) -> None:
        """Choose a mode, and wait until it is on, at most ``timeout`` [simulated s]."""
        self.set_mode(name, timeout)

    def wait_until(
        self,
        condition: Callable[[], Any],
        timeout: float,
        what: str = "the condition",
        last: Callable[[], str] = lambda: "",
        hold: float = 0.0,
    ) -> None:
        """``wait`` for a condition without an argument; ``timeout`` and ``hold`` in simulated seconds."""
        self.wait(lambda _: condition(), timeout, what, last, hold)

    # ------------------------------------------------------------------ places, whose altitude is called height here

    def set_position(  # type: ignore[override]
        self, north: float, east: float, height: float | None = None, yaw: float | None = None
    ) -> None:
        """In GUIDED: go to a place from home [m], at a height above home (None: its present one) and a yaw [deg]."""
        check_finite(height=height)
        super().set_position(north, east, height, yaw)

    def wait_location(  # type: ignore[override]
        self,
        north: float,
        east: float,
        height: float | None = None,
        accuracy: float = 1.0,
        timeout: float = 120.0,
        hold: float = 0.0,
    ) -> None:
        """Until it is at a place from home [m], along the ground and in height each within ``accuracy``."""
        super().wait_location(north, east, height, accuracy, timeout, hold)

    def fly_to(
        self,
        north: float,
        east: float,
        height: float | None = None,
        yaw: float | None = None,
        accuracy: float = 1.0,
        timeout: float = 120.0,
    ) -> None:
        """``set_position`` (NED from home [m], yaw [deg]), and wait until it is there."""
        self.goto(north, east, height, yaw, accuracy, timeout)

    drive_to = fly_to

    # ------------------------------------------------------------------ parameters, sticks

    def parameter(self, name: str) -> float:
        """Ask the vehicle for a parameter's present value."""
        return self.params[name]

    def set_parameter(self, name: str, value: float) -> None:
        """Set a parameter, in its unit, and see that the vehicle took it."""
        self.params[name] = value

    def set_parameters(self, values: Mapping[str, float] | None = None, **more: float) -> None:
        """Set several, each in its unit."""
        self.params.update(values, **more)

    def parameters(self, values: Mapping[str, float] | None = None, **more: float) -> AbstractContextManager[None]:
        """``with copter.parameters(ANGLE_MAX=2000):`` sets parameters, and sets them back when the block is left."""
        return self.params.changed(values, **more)

    def set_rc(self, channels: Mapping[int, int] | None = None, **sticks: int) -> None:
        """Hold sticks: pulses [us] by channel, or ``roll=``, ``pitch=``, ``throttle=``, ``yaw=``, ``steering=``."""
        self.rc(channels, **sticks)


class Copter(Vehicle):
    """A copter."""

    def takeoff(self, height: float = 10.0, timeout: float = 60.0) -> None:
        """GUIDED, arm if need be, climb to a height above home [m], and wait until it is there."""
        check_finite(height=height)
        self.take_off(height, timeout)


class Rover(Vehicle):
    """A rover."""

    def start(self) -> None:
        """GUIDED and armed: ready to drive."""
        self.guided_and_armed()

    def stop(self, timeout: float = 30.0) -> None:
        """HOLD, and wait until it stands, at most ``timeout`` [simulated s]."""
        self.set_mode("HOLD")
        self.wait_groundspeed(0.0, 0.1, timeout, 1.0)
