# SPDX-License-Identifier: BSD-3-Clause
"""Physics at the other end of a MAVLink HIL link (``sitl physics``): one exchange a tick, in lockstep.

The autopilot's clock is the physics'. While the physics is silent or gone, time stands; controls that were not
answered are said again once it is back, so that no tick is lost or flown twice. A physics that is found at another time
has begun anew, and the autopilot begins anew with it.
"""

from __future__ import annotations

import time
from collections.abc import Callable

from ..bridge.hil.autopilot_end import TAKEN, WAITING, AutopilotEnd
from ..physics.carried import Carried
from ..physics.engine import EngineError
from ..vehicle.core_entry import bind_unit
from ..vehicle.sim_parameters import PREFIX
from ..vehicles import apply
from .hil_link import HilLink, parse_address
from .plant import PhysicsLostError, Plant, SimulatedVehicle

PATIENCE_S = 2.5
"""Silence after which the physics counts as lost [s of wall time]."""
RESEND_S = 1.0
"""Silence after which controls are said again [s of wall time]."""


def make(vehicle: SimulatedVehicle, address: str) -> Plant:
    """The plant of ``--physics hil:tcp:HOST:PORT``."""
    return HilPlant(vehicle, HilLink(parse_address(address)), PATIENCE_S)


class HilPlant(Plant):
    """One vehicle whose physics is elsewhere.

    Args:
        vehicle: record, airframe and kind.
        link: to the physics.
        patience_s: silence after which the physics counts as lost [s of wall time].
    """

    name = "hil"
    has_truth_in_record = False
    idle_parameters = ("SIM_ACC2_", "SIM_ACCEL2_", "SIM_GYR2_", "SIM_MAG2_", "SIM_MAG3_", "SIM_GPS2_", "SIM_BAR2_")

    def __init__(self, vehicle: SimulatedVehicle, link: HilLink, patience_s: float) -> None:
        super().__init__(vehicle)
        self.link, self._patience_s = link, patience_s
        apply(vehicle.airframe, vehicle.v)
        self.end = AutopilotEnd(vehicle.fleet, vehicle.index, vehicle.v, vehicle.kind.mav_type)
        self._has_joined = self._is_silent = False
        self._fly = bind_unit(vehicle.kind.fly, vehicle.kind, vehicle.fleet, vehicle.index)
        self._event_count: Callable[[], int] = vehicle.reader.field("autopilot.events.count")
        self._attention: Callable[[], int] = vehicle.reader.field("autopilot.events.attention")
        self._clock: Callable[[], int] = vehicle.reader.field("time_us")

    # ------------------------------------------------------------------ power-on

    def power_on(self) -> None:
        """Join the physics as it stands; later times it is event_count to begin anew.

        Raises:
            PhysicsLostError: nobody is there, or nobody answers.
        """
        apply(self.vehicle.airframe, self.vehicle.v)
        if not self.link.is_open:
            self.link.open(0.0 if self._has_joined else self._patience_s)
        end = self.end
        ask = end.ask_reboot() if self._has_joined else end.ask_state()
        self.link.send(end.hello(self._world()) + ask)
        self._wait_for(lambda found: found == TAKEN)
        self._has_joined = True

    def _world(self) -> dict[str, float]:
        """The parameters of the world."""
        params = self.vehicle.v.autopilot.params
        table = self.vehicle.kind.firmware.table
        return {p.name: float(params[p.name]) for p in table.with_effect if p.name.startswith(PREFIX)}

    # ------------------------------------------------------------------ going on

    def run(self, ticks: int) -> None:
        fly, event_count, attention = self._fly, self._event_count, self._attention
        before = event_count()
        for _ in range(ticks):
            if not self._exchange():
                return
            fly()
            if attention() or event_count() != before:
                return

    def _exchange(self) -> bool:
        """Controls out, the next tick in; False when the physics has begun anew."""
        link, end = self.link, self.end
        if not link.is_open:
            self._open()
        link.send(end.controls())
        found = self._listen()
        if found == WAITING:
            found = self._wait_for(lambda found: found != WAITING, end.controls())
        if found == TAKEN:
            return True
        self.vehicle.restarted()
        return False

    def _open(self) -> None:
        self.link.open()
        self.link.send(self.end.hello(self._world()))

    def _wait_for(self, is_it: Callable[[int], bool], again: bytes = b"") -> int:
        """Listen until that is found; ``again`` is said once a second. Who has been silent for long is not given as
        much time as others.

        Raises:
            PhysicsLostError: not within the patience, or the connection is lost.
        """
        link = self.link
        begun = said = time.monotonic()
        patience = 0.0 if self._is_silent else self._patience_s
        while True:
            found = self._listen()
            if is_it(found):
                self._is_silent = False
                return found
            now = time.monotonic()
            if now - begun > patience:
                self._is_silent = True
                raise self._lost(f"physics at {link.name} does not answer")
            if again and now - said > RESEND_S:
                said = now
                link.send(again)

    def _listen(self) -> int:
        """Take what has come, or wait a moment for it; what the physics said goes with the news that it is lost."""
        try:
            return self.end.feed(self.link.receive())
        except PhysicsLostError as error:
            raise self._lost(str(error)) from None

    def _lost(self, why: str) -> PhysicsLostError:
        notes, self.end.notes = self.end.notes, []
        return PhysicsLostError(why + (f" ({'; '.join(notes)})" if notes else ""))

    # ------------------------------------------------------------------ the rest

    def truth(self) -> Carried:
        """Asked for when it is wanted; as last known while the physics does not answer."""
        link, end = self.link, self.end
        if end.truth_us != self._clock() and not end.is_waiting:
            try:
                if not link.is_open:
                    self._open()
                link.send(end.ask_truth())
                self._wait_for(lambda _: end.truth_us >= self._clock())
            except PhysicsLostError:
                pass  # the next tick says so
        return end.truth

    def parameter_changed(self, name: str) -> None:
        value = float(self.vehicle.v.autopilot.params[name])
        super().parameter_changed(name)  # takes a shove
        self.end.set_parameter(name, value)

    def reseed(self, seed: int) -> None:
        self.end.reseed(seed)

    def snapshot(self) -> bytes:
        raise EngineError("a physics at the other end of a link cannot be put back: choose native, pybullet or jsbsim")

    def restore(self, state: bytes) -> None:
        self.snapshot()

    def close(self) -> None:
        self.link.close()
