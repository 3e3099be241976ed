# SPDX-License-Identifier: BSD-3-Clause
"""Physics at the other end of ArduPilot's JSON interface: any simulator that serves ``arducopter --model JSON:HOST``.

It tells where the vehicle is and how it moves; what our autopilot sees is made of that by our own sensor models, with
the noise, delays and biases of the airframe, as ArduPilot's simulator makes its own. Lockstep: one tick of 2500 us for
each that the physics' clock has gone on. Physics with finer steps is asked again until the tick is full (the IMU gets
the mean), with longer ones the ticks of a step see the same motion.
"""

from __future__ import annotations

import math
import struct
import time
from collections.abc import Callable

from ..bridge.ardupilot_json.answer import Motion
from ..bridge.ardupilot_json.autopilot_end import LONGEST_S, AutopilotEnd
from ..core import rng
from ..core.algebra import multiply, rotate
from ..core.constants import GRAVITY, TICK_S, TICK_US
from ..core.elementary import cos, sin
from ..core.record_reader import locate
from ..core.vectors import Quat, Vec3
from ..physics.carried import Carried, carried
from ..physics.engine import EngineError
from ..physics.native.body import unit
from ..physics.native.power_on import DEFAULT_HOME, Home
from ..vehicle.core_entry import bind_unit
from .json_link import WAIT_S, JsonLink, parse_address
from .plant import PhysicsLostError, Plant, SimulatedVehicle

OWN = ("home", "seed", "estimator")
"""Options of a simulation that are the autopilot's at this kind of link: the physics knows no position on the earth."""
RESEND_S = 1.0
"""Wall time after which a frame without an answer is sent again, as ArduPilot does [s]."""
PATIENCE_S = 2.5
"""Wall time without an answer after which the physics is lost [s]."""
STILL_S = 0.001
"""After a line without new time another one is waited for so long before the frame is sent again [s]: physics that goes
by a clock of its own is asked until it has gone on."""
_BODY = struct.Struct("<13d")
_ZERO: tuple[float, ...] = (0.0, 0.0, 0.0)
_NOTHING = _ZERO, _ZERO, 0.0
_US = 1e6


def make(
    vehicle: SimulatedVehicle, address: str, home: Home | None = None, seed: int | None = None, **_: object
) -> Plant:
    """The plant of ``--physics json:HOST:PORT``."""
    plant = JsonPlant(vehicle, JsonLink(parse_address(address)), home, seed or 0)
    plant.load()  # now, and not while the physics waits
    return plant


class JsonPlant(Plant):
    """One vehicle whose physics is a JSON simulator.

    Args:
        vehicle: record, airframe and kind.
        link: datagrams to and from the simulator.
        home: where the position (0, 0, 0) of the physics is on the earth.
        seed: of the sensors' noise.
        clock: wall time [s], for repeats and patience.
    """

    name = "json"
    idle_parameters = ("SIM_ENGINE_", "SIM_SHOVE_", "SIM_TWIST_", "SIM_WIND_")

    def __init__(
        self,
        vehicle: SimulatedVehicle,
        link: JsonLink,
        home: Home | None,
        seed: int,
        clock: Callable[[], float] = time.monotonic,
    ) -> None:
        super().__init__(vehicle)
        self.link, self.home, self.seed = link, home or DEFAULT_HOME, seed
        self.end = AutopilotEnd()
        self._wall = clock
        self._behind_us = 0.0
        """Time of the physics less that of the vehicle [us]: time it has to step before the next tick is full."""
        self._last: Motion | None = None
        self._sums = _NOTHING
        """What the IMU has felt in the part of the tick that is done: rates and forces by steps, sum of steps [s]."""
        self._event_count: Callable[[], int] = vehicle.reader.field("autopilot.events.count")
        self._attention: Callable[[], int] = vehicle.reader.field("autopilot.events.attention")
        self._pulses = vehicle.reader.fields("actuators.pwm")
        self._memory = memoryview(vehicle.fleet.view("u1"))  # type: ignore[arg-type]
        self._body_at = (
            vehicle.index * vehicle.fleet.dtype.itemsize + locate(vehicle.fleet.dtype, "physics.body.pos")[0]
        )
        self._units: tuple[Callable[[], None], ...] = ()
        self._substeps = int(vehicle.airframe.value("substeps")) if vehicle.airframe.has("substeps") else 0
        self._note = ""
        """Why lines were not taken."""

    # ------------------------------------------------------------------ power-on

    def power_on(self) -> None:
        vehicle = self.vehicle
        vehicle.kind.apply_sim_parameters(vehicle.v)
        vehicle.kind.init_physics(vehicle.v, vehicle.airframe, self.home, self.seed)
        self.end.restart()
        self._behind_us, self._last, self._sums = 0.0, None, _NOTHING

    def load(self) -> None:
        """Compile all that ``run`` needs now."""
        if not self._units:
            vehicle, pieces = self.vehicle, self.vehicle.kind.pieces
            wanted = pieces.begin, pieces.load, pieces.sense, vehicle.kind.fly
            self._units = tuple(bind_unit(unit, vehicle.kind, vehicle.fleet, vehicle.index) for unit in wanted)

    # ------------------------------------------------------------------ going on

    def run(self, ticks: int) -> None:
        self.load()
        begin, load, sense, fly = self._units
        event_count, attention, before = self._event_count, self._attention, self._event_count()
        for _ in range(ticks):
            motion = self._next()
            if motion is None:
                return
            begin()
            for _ in range(self._substeps):
                load()  # the rotors' power, for the battery
            self._move(motion)
            sense()
            self._others(motion)
            fly()
            if attention() or event_count() != before:
                return

    def _next(self) -> Motion | None:
        """The motion at the end of the next tick; None when the physics has begun anew, and so must the autopilot."""
        began = self._wall()
        gyro, accel, weight = self._sums
        while self._behind_us < 0.5 * TICK_US or self._last is None:
            answer = self._exchange(began)
            if answer is None:
                return None
            motion, step = answer
            self._last = motion
            if step > LONGEST_S:  # a clock that jumps takes nothing with it
                self._behind_us = TICK_US
            else:
                self._behind_us += step * _US
            gyro = tuple(g + step * x for g, x in zip(gyro, motion.gyro))
            accel = tuple(a + step * x for a, x in zip(accel, motion.accel))
            weight += step
            self._sums = gyro, accel, weight  # kept, should the physics be lost before the tick is full
        self._sums = _NOTHING
        self._behind_us -= TICK_US
        last = self._last
        if weight == 0.0 or gyro == last.gyro:
            return last
        k = 1.0 / weight
        mean_gyro, mean_accel = tuple(k * g for g in gyro), tuple(k * a for a in accel)
        return Motion(
            last.time, mean_gyro, mean_accel, last.position, last.velocity, last.attitude,
            last.ranges, last.battery, last.receiver,
        )  # fmt: skip

    def _exchange(self, began: float) -> tuple[Motion, float] | None:
        """Frame out, line in; None when the physics' time went backwards.

        Args:
            began: when the tick was begun [s of wall time].

        Raises:
            PhysicsLostError: no line with new time within the patience.
        """
        frame = self.end.frame(self._pulses())
        self.link.send(frame)
        sent, stands = self._wall(), False
        while True:
            data = self.link.receive(STILL_S if stands else WAIT_S)
            if data is not None:
                answer = self.end.receive(data)
                if self.end.note:
                    self._note, self.end.note = self.end.note, ""
                if answer is not None:
                    if answer[1] < 0.0:
                        self.vehicle.restarted()
                        return None
                    if answer[1] > 0.0:
                        return answer
                    stands = True
            now = self._wall()
            if now - began >= PATIENCE_S:
                why = f"; {self.end.refused} lines were refused, {self._note}" if self.end.refused else ""
                what = "answers, but its time stands" if stands else "does not answer"
                raise PhysicsLostError(f"physics json:{self.link.name} {what}{why}")
            if data is None and (stands or now - sent >= RESEND_S):
                self.link.send(frame)
                sent = now

    def _move(self, motion: Motion) -> None:
        """Write the motion, and the one before that the IMU's laws make this line's gyro and accel of."""
        m = self.vehicle.v.physics.motion
        q = Quat(*motion.attitude)
        _BODY.pack_into(self._memory, self._body_at, *motion.position, *motion.velocity, *q, *motion.gyro)
        gx, gy, gz = motion.gyro
        half = 0.5 * TICK_S * math.sqrt(gx * gx + gy * gy + gz * gz)
        k = -0.5 * TICK_S * (sin(half) / half if half > 1e-9 else 1.0)
        m.q = multiply(q, Quat(cos(half), k * gx, k * gy, k * gz))
        acc = rotate(unit(m.q + q), Vec3(*motion.accel))
        m.vel = Vec3(*motion.velocity) - TICK_S * Vec3(acc.x, acc.y, acc.z + GRAVITY)

    def _others(self, motion: Motion) -> None:
        """What a line may tell beside the motion."""
        sensors = self.vehicle.v.sensors
        if motion.receiver:
            channels = motion.receiver[: len(sensors.rc_channels)]
            sensors.rc_channels[: len(channels)] = channels
            sensors.rc_count += 1
            sensors.rc_time_us = sensors.time_us
        if motion.battery is not None:
            sensors.battery_voltage, sensors.battery_current = motion.battery
        if motion.ranges and motion.ranges[0] is not None:
            longest = float(self.vehicle.airframe.value("rangefinder_max"))
            reading = motion.ranges[0]
            sensors.rangefinder_range[0] = reading if longest <= 0.0 or reading < longest else math.inf
            sensors.rangefinder_count += 1

    # ------------------------------------------------------------------ the rest

    def truth(self) -> Carried:
        return carried(self.vehicle.v)

    def reseed(self, seed: int) -> None:
        rng.seed(self.vehicle.v.rng, seed)

    def snapshot(self) -> bytes:
        raise EngineError("physics behind a JSON link has no snapshots; native physics has")

    def restore(self, state: bytes) -> None:
        raise EngineError("physics behind a JSON link has no snapshots; native physics has")

    def close(self) -> None:
        self.link.close()
