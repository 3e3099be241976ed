# SPDX-License-Identifier: BSD-3-Clause
"""JSBSim as the engine of one vehicle.

A tick is as many frames of JSBSim as the airframe has substeps. A frame first moves the vehicle by what acted on it at
the end of the last one and then works out what acts now, so that an actuator shows one frame later than in native
physics. Integrators without a memory are chosen, for restoring: Buss' second-order rotation, and Euler's rule for
velocity and position, which then stands half a frame behind the velocity; it is reported with that made up for.

JSBSim cannot give or take its whole state. What its state follows from is all in the vehicle's record: a snapshot makes
JSBSim start anew from the record, and so does restoring it, and both go on from the same bits. The new start changes
the flight that goes on by rounding.
"""

from __future__ import annotations

from typing import Any, ClassVar

from ...core.algebra import euler_of, quat_from_euler, rotate
from ...core.constants import TICK_S
from ...core.vectors import Euler, Quat, Vec3
from ..engine import Engine, EngineError, EngineVehicle
from ..native.atmosphere import SEA_LEVEL_TEMPERATURE, pressure, temperature
from . import start
from .aircraft import RADIUS
from .formula import library, load
from .model import FOOT, PASCALS, RANKINE, Properties, VehicleModel, writer

_NONE, _MILSPEC = 0.0, 3.0


class Air:
    """What the vehicle flies in."""

    def __init__(self, properties: Properties) -> None:
        self._warmer = properties.writer("atmosphere/delta-T")
        self._pressure = properties.writer("atmosphere/P-sl-psf")
        self._wind = [properties.writer(f"atmosphere/wind-{axis}-fps") for axis in ("north", "east", "down")]
        self._model = properties.writer("atmosphere/turb-type")
        self._strength = properties.writer("atmosphere/turbulence/milspec/windspeed_at_20ft_AGL-fps")
        self._severity = properties.writer("atmosphere/turbulence/milspec/severity")
        self._seed = properties.writer("simulation/randomseed")
        self.wind: list[float] = []
        """That blows, NED [m/s]."""
        self.turbulence = 0.0
        """Standard deviation of its vertical axis [m/s]."""
        self.has_stirred = False
        """There has been turbulence; its filters cannot be emptied."""

    def settle(self, altitude: float) -> None:
        """Be the air over a floor at this altitude above mean sea level [m]."""
        self._warmer((temperature(altitude) - SEA_LEVEL_TEMPERATURE) / RANKINE)
        self._pressure(pressure(altitude) / PASCALS)

    def seed(self, number: int) -> None:
        """Let the random numbers of turbulence begin anew."""
        self._seed(float(number % 2147483647))

    def blow(self, wind: list[float]) -> None:
        """Blow steadily: NED [m/s]."""
        self.wind = wind
        for write, speed in zip(self._wind, wind, strict=True):
            write(speed / FOOT)

    def stir(self, deviation: float) -> None:
        """Be turbulent, with this standard deviation of the vertical axis [m/s]; 0: not at all.

        Near the ground the standard takes it for a tenth of the wind at 20 ft; along the other axes it is larger, by
        less the higher the vehicle is.
        """
        self.turbulence = deviation
        self.has_stirred |= deviation > 0.0
        self._strength(10.0 * deviation / FOOT)
        self._severity(1.0)
        self._model(_MILSPEC if deviation > 0.0 else _NONE)

    def be_still(self) -> None:
        """No turbulence until the next ``stir``."""
        self._model(_NONE)


_STATE = (
    "position/lat-gc-rad",
    "position/long-gc-rad",
    "position/h-sl-ft",
    "velocities/v-north-fps",
    "velocities/v-east-fps",
    "velocities/v-down-fps",
    "attitude/phi-rad",
    "attitude/theta-rad",
    "attitude/psi-rad",
    "velocities/p-rad_sec",
    "velocities/q-rad_sec",
    "velocities/r-rad_sec",
)


class JsbsimEngine(Engine):
    """One vehicle in a JSBSim of its own.

    Args:
        vehicle: where its record is. The world may have a floor, but no solids.
        model: what is special about the kind of vehicle.

    Raises:
        EngineError: the world has solids.
        MissingExtra: JSBSim is not installed.
    """

    name: ClassVar[str] = "jsbsim"

    def __init__(self, vehicle: EngineVehicle, model: VehicleModel) -> None:
        super().__init__(vehicle)
        library()
        if vehicle.world is not None and len(vehicle.world.geometry) > 0:
            raise EngineError(
                f"world {vehicle.world.name!r}: physics 'jsbsim' knows no solids; take physics 'native' or 'pybullet'"
            )
        self.model = model
        self.idle_parameters = model.idle_parameters
        self.executive: Any = None
        """JSBSim's FGFDMExec."""
        self._airframe = b""
        self._physics = vehicle.v.physics
        self._wind = vehicle.v.physics.wind
        self._write_body = writer(vehicle, "physics.body.pos", 13)

    # ------------------------------------------------------------------ starting

    def place(self) -> None:
        self._fit(anew=self.executive is not None and self.air.has_stirred)
        self._start()

    def _fit(self, anew: bool) -> None:
        """An aircraft of the vehicle's properties as they are now; ``anew``, in air that nothing has stirred."""
        airframe = bytes(self._physics.airframe._bytes)
        if airframe != self._airframe or anew:
            self._load()
            self._airframe = airframe

    def _load(self) -> None:
        """Have JSBSim take the vehicle as its properties are now."""
        a, model = self._physics.airframe, self.model
        self.frames = model.frames(a)
        self.dt = TICK_S / self.frames
        self.executive = load(model.document(a, self.dt), self.dt)
        self._height = model.height(a)
        properties = Properties(self.executive)
        self._state = [properties.reader(name) for name in _STATE]
        self._run = self.executive.run
        self.air = Air(properties)
        model.bind(properties, a, self.dt)

    def _start(self) -> None:
        """Start JSBSim from what the record says."""
        p = self._physics
        self.air.be_still()
        self.air.seed(int(self.vehicle.v.rng.s[0]))
        start.begin(self.executive, self._motion())
        self.air.settle(float(p.origin.alt))
        self.air.blow(list(p.wind.steady))
        self.model.starting()
        self.model.inputs()
        start.settle(self.executive)
        self.model.started()
        self.air.stir(float(p.wind.turbulence))

    def _motion(self) -> start.Motion:
        """Of the centre of mass, from the record."""
        b, half = self._physics.body, 0.5 * self.dt
        lever, swing = self._lever(b.q, b.rates)
        velocity = b.vel + swing
        centre = b.pos + lever - half * velocity
        return start.Motion((centre.x, centre.y, self._height - centre.z), velocity, euler_of(b.q), b.rates)

    def _lever(self, q: Quat, rates: Vec3) -> tuple[Vec3, Vec3]:
        """From the origin of the body to its centre of mass: position [m] and velocity [m/s], NED."""
        ahead = self.model.ahead
        return rotate(q, Vec3(ahead, 0.0, 0.0)), rotate(q, Vec3(0.0, ahead * rates.z, -(ahead * rates.y)))

    # ------------------------------------------------------------------ going on

    def move(self) -> None:
        air = self.air
        wind = list(self._wind.steady)
        if wind != air.wind:
            air.blow(wind)
        if self._wind.turbulence != air.turbulence:
            air.stir(self._wind.turbulence)
        self.model.inputs()
        for _ in range(self.frames):
            self._run()
        lat, lon, height, vn, ve, vd, roll, pitch, yaw, p, q, r = [read() for read in self._state]
        vn, ve, vd = FOOT * vn, FOOT * ve, FOOT * vd
        half = 0.5 * self.dt
        north, east, down = RADIUS * lat + half * vn, RADIUS * lon + half * ve, self._height - FOOT * height + half * vd
        attitude = quat_from_euler(Euler(roll, pitch, yaw))
        if self.model.ahead != 0.0:
            (x, y, z), (vx, vy, vz) = self._lever(attitude, Vec3(p, q, r))
            north, east, down, vn, ve, vd = north - x, east - y, down - z, vn - vx, ve - vy, vd - vz
        self._write_body(north, east, down, vn, ve, vd, *attitude, p, q, r)
        self.model.outputs(vd)

    # ------------------------------------------------------------------ going back

    def snapshot(self) -> bytes:
        if self.air.turbulence > 0.0:
            raise EngineError(
                "physics 'jsbsim' has a turbulence of its own, which cannot be restored: set SIM_WIND_TURB to 0 "
                "or take physics 'native'"
            )
        self._go_on()
        return b""

    def restore(self, state: bytes) -> None:
        self._go_on()

    def _go_on(self) -> None:
        """From the record. Snapshots are of still air."""
        self._fit(anew=self.air.has_stirred and not self._physics.wind.turbulence > 0.0)
        self._start()

    def close(self) -> None:
        self.executive = None
