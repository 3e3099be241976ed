# SPDX-License-Identifier: BSD-3-Clause
"""Faults of the simulated world, by the SIM_ parameters of ArduPilot's SITL, and a ground station that falls silent."""

from __future__ import annotations

from types import TracebackType

from sitl.client import Client, UnknownNameError

__tracebackhide__ = True

FAULTS = ("gps", "rc", "motor", "station", "wind")


class Fault:
    """A fault that lasts until ``repair``, or until the end of a ``with`` block."""

    def __init__(self, vehicle: Faulty, values: dict[str, float], silent: bool = False) -> None:
        self._vehicle, self._silent = vehicle, silent
        self._before = {name: vehicle.params[name] for name in values}
        vehicle.params.update(values)
        if silent:
            vehicle.heartbeats(False)

    def repair(self) -> None:
        """All is as before."""
        self._vehicle.params.update(self._before)
        if self._silent:
            self._vehicle.heartbeats(True)

    def __enter__(self) -> Fault:
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        if error is None:
            self.repair()


class Faulty(Client):
    """A vehicle that can fail."""

    def fail(self, what: str, *, motor: int = 1, thrust: float = 0.0, speed: float = 10.0, direction: float = 0.0,
             turbulence: float = 0.0) -> Fault:  # fmt: skip
        """Let something fail, until ``.repair()`` of what this gives, or for a ``with`` block.

        Args:
            what: "gps": no fix any more; "rc": the transmitter is off; "motor": number ``motor`` (copters) keeps
                a share ``thrust`` of its thrust; "station": no heartbeat of this ground station any more;
                "wind": ``speed`` [m/s] from ``direction`` [deg] with ``turbulence`` [m/s].
        """
        if what == "gps":
            return Fault(self, {"SIM_GPS1_ENABLE": 0})
        if what == "rc":
            return Fault(self, {"SIM_RC_FAIL": 1})
        if what == "wind":
            return Fault(self, {"SIM_WIND_SPD": speed, "SIM_WIND_DIR": direction, "SIM_WIND_TURB": turbulence})
        if what == "station":
            return Fault(self, {}, silent=True)
        has_motors = "SIM_ENGINE_FAIL" in self.simulation.kind.firmware.table
        if what == "motor" and has_motors:
            return Fault(self, {"SIM_ENGINE_MUL": thrust, "SIM_ENGINE_FAIL": 1 << (motor - 1)})
        known = [name for name in FAULTS if name != "motor" or has_motors]
        raise UnknownNameError(f"a {self.kind} has no fault {what!r}; there are {', '.join(known)}")
