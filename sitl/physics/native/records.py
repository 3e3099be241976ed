# SPDX-License-Identifier: BSD-3-Clause
"""Records that the physics of every vehicle has.

SI units; NED frame from the home ground point, in a world from its origin on the floor (pos[2] negative up); FRD body
frame; quaternions body to NED.
Only physics and the shell read them; the autopilot sees ``sensors``.
"""

from __future__ import annotations

from typing import Annotated, Protocol, TypeVar

from ...core.border import Actuators, NarrowVec3, Sensors
from ...core.records import Float32, FloatRows, Floats, Int32, Ints, Record, Records, Stored, array, repeat
from ...core.rng import Rng
from ...core.vectors import Quat, Vec3
from ...vehicles.properties.body import Properties
from ...worlds.geometry import SOLID_COLUMNS

GROUND_AIRBORNE = 0
GROUND_STANDING = 1
GROUND_LYING = 2
"""Tipped over: it stays as it fell, whatever the rotors do."""


class Derived(Record):
    """What follows from the properties (``prepare``), so that a tick needs no exp: what all vehicles have."""

    charge_per_amp: float  # loss of charge (of 1) per ampere and tick
    acc_noise: float  # standard deviation of one sample [m/s^2]
    gyro_noise: float
    acc_bias_decay: float  # first-order Gauss-Markov step of the in-run bias: left over, and noise added
    acc_bias_step: float
    gyro_bias_decay: float
    gyro_bias_step: float
    gps_period: int  # [ticks]
    gps_delay: int
    gps_start: int
    gps_fix: int
    gps_drift_decay: float
    gps_drift_step: float  # for a drift of standard deviation 1
    baro_period: int
    baro_drift_decay: float
    baro_drift_step: float
    mag_period: int


class Body(Record):
    """Where the body really is and how it moves."""

    pos: Vec3  # NED from the home ground point, in a world from its origin on the floor [m]
    vel: Vec3  # NED [m/s]
    q: Quat  # body to NED
    rates: Vec3  # body [rad/s], now
    rates_mean: Vec3  # body [rad/s], mean over the last tick: what an integrating gyro measures
    acc_ned: Vec3  # acceleration NED, mean over the last tick [m/s^2]
    specific_force: Vec3  # body, mean over the last tick [m/s^2]; at rest and level (0, 0, -9.80665)


class Motion(Record):
    """What passes between the common laws and an engine that moves the body (``sitl.physics.engine``)."""

    force: Vec3  # on the body but gravity and ground, FRD [N]
    torque: Vec3  # FRD [N m]
    contact: Vec3  # change of velocity in this tick that hard contacts gave, NED [m/s]
    vel: Vec3  # body.vel before this tick, NED [m/s]
    q: Quat  # body.q before this tick


class BatteryState(Record):
    """The battery."""

    charge: float  # 1 full .. 0 empty
    voltage: float  # at the terminals [V]
    full_voltage: float  # open circuit, full, in place of the airframe's [V]; 0: the airframe's (SIM_BATT_VOLTAGE)
    current: float  # [A]
    capacity: Float32  # full, in place of the airframe's [Ah]; 0: the airframe's (SIM_BATT_CAP_AH)
    resistance: Float32  # inner, besides the airframe's [Ohm] (SIM_BATT_RES)


class Air(Record):
    """The air around the vehicle."""

    density: float  # at the vehicle [kg/m^3]
    density_root: float  # its square root [sqrt(kg/m^3)]


class Wind(Record):
    """Wind and gusts."""

    speed: float  # steady wind [m/s] (SIM_WIND_SPD)
    direction: float  # where it comes from [deg] (SIM_WIND_DIR)
    turbulence: float  # standard deviation of each axis [m/s] (SIM_WIND_TURB)
    time_constant: float  # correlation time of turbulence and lag of changes [s] (SIM_WIND_TC)
    is_shaped: bool  # it depends on the height, or blows upwards
    is_shared: bool  # gusts come from outside: they are those of all vehicles of a world
    profile: Int32  # how it depends (SIM_WIND_T)
    full_height: Float32  # above home [m] (SIM_WIND_T_ALT)
    gain: Float32  # of a linear profile [1/s] (SIM_WIND_T_COEF)
    elevation: Float32  # how far it blows upwards [deg] (SIM_WIND_DIR_Z)
    steady: Vec3  # NED, after the lag [m/s]
    gust: Vec3  # NED [m/s]
    vel: Vec3  # NED, steady and gust: what the vehicle meets


GPS_RING = 8
"""Fixes under way to the reader; while there are so many, no more are taken (SIM_GPS1_LAG_MS)."""


class Fix(Record):
    """What a GPS receiver found, on its way to the reader."""

    due: int  # tick of delivery
    type: Int32  # MAVLink's GPS_FIX_TYPE
    lat: Int32  # [degE7]
    lon: Int32  # [degE7]
    alt: Int32  # above mean sea level [mm]
    vel: Annotated[Vec3, Stored("i4")]  # NED, whole [cm/s]
    jammed: bool


class Jam(Record):
    """What a jammed GPS receiver makes of its position."""

    pos: Vec3  # NED, error [m]
    vel: Vec3  # NED [m/s]
    eph: int  # HDOP * 100
    epv: int  # VDOP * 100
    satellites: int


class GpsFault(Record):
    """What is wrong with what a receiver sends (SIM_GPS1_*)."""

    is_on: bool
    delay: Int32  # [ticks]; -1: the airframe's
    satellites: Int32  # that are reported; -1: the airframe's
    lat: Int32  # added [degE7]
    lon: Int32  # added [degE7]
    alt: Float32  # added [m]
    noise: Float32  # amplitude of a fast wave of the altitude [m]
    drift: Float32  # amplitude of a slow one [m]
    vel: NarrowVec3  # added, NED [m/s]
    loss: Float32  # share of the fixes that are lost


RECEIVERS = 2


class GpsReceiver(Record):
    """A GPS receiver, and what is wrong with it."""

    present: bool  # the vehicle has it; the first one counts as there anyhow
    off: bool  # it is switched off
    jammed: bool  # (SIM_GPS1_JAM)
    jam_end: int  # tick at which the jammed receiver shows fixes again, however wrong; 0: not jammed so far
    jam: Jam  # the last wrong one
    drift: Vec3  # NED, in standard deviations
    head: int  # fixes taken so far
    tail: int  # fixes delivered so far
    fixes: Records[Fix] = repeat(Fix, GPS_RING)  # fix n at n % GPS_RING
    fault: GpsFault


BARO_RING = 50
"""Samples of a barometer that are kept: 1 s at 50 Hz."""


BAROMETERS = 2


class BaroFault(Record):
    """What is wrong with a barometer (SIM_BARO_*, SIM_BAR2_*)."""

    is_on: bool
    off: bool
    frozen: bool
    height: Float32  # added [m]
    noise: Float32  # standard deviation [m]
    drift: Float32  # [m/s]
    drifted: float  # so far [m]; stays when the drift ends
    delay: Int32  # [samples]
    front: NarrowVec3  # share of the dynamic pressure that is added, of air from the front, right, below
    back: NarrowVec3  # the same, from behind, left, above
    taken: Int32  # samples in the ring so far
    ring: Floats = array(BARO_RING, stored="f4")  # pressures [Pa]; sample n at n % BARO_RING


class RangeFault(Record):
    """What is wrong with range-finder and lidar (SIM_SONAR_*, SIM_LIDAR_LOSS)."""

    is_on: bool
    glitch: Float32  # added to the range-finder's reading [m]
    noise: Float32  # of it, standard deviation [m]
    loss: Float32  # share of its readings that see nothing
    lidar_loss: Float32  # the same, of the lidar's


COMPASSES = 3


class Iron(Record):
    """What iron in the vehicle does to a compass."""

    hard: Vec3  # what it shows too little, body [gauss] (SIM_MAG1_OFS: what it differs from the offsets at delivery)
    is_soft: bool
    gain_error: float  # share that it shows too much (SIM_MAG1_SCALING)
    x: Vec3  # rows of what soft iron makes of a field, body
    y: Vec3
    z: Vec3


IMUS = 2


class ImuFault(Record):
    """What is wrong with an accelerometer and a gyro, besides what all have."""

    acc_bias: Vec3  # body [m/s^2] (SIM_ACC1_BIAS)
    acc_stretch: Vec3  # scale error, body (SIM_ACC1_SCAL)
    acc_noise: float  # while motors turn [m/s^2] (SIM_ACC1_RND)
    acc_stuck: float  # all that its axes show [m/s^2]; 0: it is not stuck (SIM_ACCEL1_FAIL)
    gyro_bias: Vec3  # body [rad/s] (SIM_GYR1_BIAS)
    gyro_stretch: Vec3  # scale error, body (SIM_GYR1_SCALE)
    gyro_noise: float  # while motors turn [rad/s] (SIM_GYR1_RND)


class SensorState(Record):
    """What is wrong with the sensors; hidden from the autopilot."""

    acc_bias: Vec3  # turn-on bias, body [m/s^2]
    acc_walk: Vec3  # in-run bias, body [m/s^2]
    acc_is_turned: bool  # in the vehicle
    acc_mount: Quat  # from the vehicle's axes to the sensor's (SIM_ACC_TRIM)
    acc_scale: Vec3  # 1 + error, body
    gyro_bias: Vec3  # turn-on bias, body [rad/s]
    gyro_walk: Vec3  # in-run bias, body [rad/s]
    gyro_scale: Vec3  # 1 + error, body
    gps: Records[GpsReceiver] = repeat(GpsReceiver, RECEIVERS)
    imus_faulty: bool  # one of them, or both
    imu_state: int  # ``sensors.imu_state``
    imus: Records[ImuFault] = repeat(ImuFault, IMUS)
    vibration_hz: Vec3  # of the body's axes; 0, 0, 0: none (SIM_VIB_FREQ)
    compass_silent: int  # bit k: compass k sends nothing (SIM_MAG1_FAIL)
    is_disturbed: bool  # by one of these:
    compass_noise: float  # [gauss] (SIM_MAG_RND)
    compass_by_current: Vec3  # field, body [gauss/A] (SIM_MAG_MOT)
    baro_drift: float  # in standard deviations
    baro_missing: bool  # none was found at power-on (SIM_BARO_COUNT)
    baros: Records[BaroFault] = repeat(BaroFault, BAROMETERS)
    baros_differ: bool  # in what is wrong with them
    range_fault: RangeFault
    irons: Records[Iron] = repeat(Iron, COMPASSES)


FLOW_RING = 4
"""Samples of optical flow that can be on their way."""


class Downward(Record):
    """Sensors that look down, of vehicles whose parameters ask for them (SIM_FLOW_*, RNGFND1_*)."""

    present: bool  # there is one of them at least
    flow_period: int  # [ticks]; 0: there is no sensor of optical flow
    flow_delay: int  # [ticks]
    flow_noise: float  # greatest [rad/s]
    flow_head: int  # samples taken so far
    flow_tail: int  # samples delivered so far
    flow_due: Ints = array(FLOW_RING, stored="i8")  # when sample n, at n % FLOW_RING, is delivered [ticks]
    flow: Floats = array(FLOW_RING, 4, stored="f4")  # its rates about x and y, and the body's [rad/s]
    in_world: bool  # the airframe has a range-finder that the world's rays are cast for (``ranging``)
    ranges: bool  # there is one that is not
    range_min: float  # [m]
    range_max: float
    ground_d: float  # of the ground below the vehicle, down from the home ground point [m]


class Origin(Record):
    """The home ground point, known to the simulator alone."""

    lat: int  # [degE7]
    lon: int  # [degE7]
    alt: float  # above mean sea level [m]
    field: Vec3  # geomagnetic field NED [gauss]


OBSTACLES_MAX = 24
"""Solids in the list."""


class Obstacles(Record):
    """The solids near the vehicle, and contact with them."""

    present: bool  # there is a world with solids, or with other vehicles
    count: int  # rows of the list
    north: float  # where it was gathered, as body.pos [m]
    east: float  # [m]
    complete: float  # every solid nearer to there is in the list [m]
    rows: FloatRows = array(OBSTACLES_MAX, SOLID_COLUMNS)
    wanted: bool  # the list no longer does
    looked: Vec3  # where the vehicle was when distances were last worked out [m]
    clear: float  # the nearest solid was at least this far away then [m]
    turned: float  # angle that the body has turned by since then, at most [rad]
    touching: bool  # a solid
    hit_count: int  # contacts so far that were faster than HIT_SPEED
    hit_speed: Float32  # of the last one, into the solid [m/s]
    hit_time_us: int  # when the last one was
    impulse: Vec3  # velocity taken away that the accelerometer still has to show, NED [m/s]


class Physics(Record):
    """The physics of a vehicle: what all have."""

    airframe: Properties
    derived: Derived
    origin: Origin
    body: Body
    motion: Motion
    battery: BatteryState
    air: Air
    wind: Wind
    sensors: SensorState
    obstacles: Obstacles
    downward: Downward


P_co = TypeVar("P_co", bound=Physics, covariant=True)


class Vehicle(Protocol[P_co]):
    """What physics knows of a vehicle."""

    time_us: int
    tick: int
    rng: Rng
    sensors: Sensors
    actuators: Actuators

    @property
    def physics(self) -> P_co: ...

    def zero(self, *names: str) -> None: ...
