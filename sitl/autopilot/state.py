# SPDX-License-Identifier: BSD-3-Clause
"""The autopilot's record. SI units, NED world frame, FRD body frame, angles in radians unless a line says otherwise.

The border to physics is in ``core.border``.
"""

from __future__ import annotations

from typing import Protocol

from ..core.algebra import euler_of, quat_from_euler, yaw_of
from ..core.border import RC_INPUTS, Actuators, Sensors
from ..core.kernels import law
from ..core.records import Float32, Floats, Ints, Record, array
from ..core.vectors import Euler, Quat, Vec3
from .avoidance.proximity import Proximity
from .avoidance.state import Avoidance, Objects
from .barometers import Barometers
from .estimation.state import Ekf
from .estimation.yaw_bank import YawBank
from .events import Events
from .fence.state import FenceState, RallyState
from .gps_receivers import GpsChoice
from .inertial_filter import InertialFilter
from .inertial_ring import InertialRing
from .landing_target.state import LandingTarget
from .navigation.state import Nav
from .optical_flow import OpticalFlow
from .params.firmware_parameters import Parameters
from .sensor_calibration import Calibrated
from .vibration import Vibration
from .visual_odometry import VisualOdometry


class Estimate(Record):
    """What the estimator says of the vehicle."""

    q: Quat  # body to NED
    rates: Vec3  # body rates without bias, low-passed [rad/s], every tick
    acc_ned: Vec3  # acceleration NED, gravity removed, low-passed [m/s^2], every tick
    vel: Vec3  # NED [m/s]
    pos: Vec3  # NED from the origin [m]
    gyro_bias: Vec3  # body [rad/s]
    acc_bias: Vec3  # body [m/s^2]
    origin_set: bool
    origin_lat: int  # [degE7]
    origin_lon: int  # [degE7]
    origin_alt: float  # above mean sea level [m]
    status_flags: int  # EKF_STATUS_FLAGS
    variance_vel: float  # normalised test ratios as in EKF_STATUS_REPORT
    variance_pos: float
    variance_hgt: float
    variance_mag: float
    innovation_vel_d: float  # estimate minus measurement, of the last GPS fix [m/s]
    innovation_pos_d: float  # of the last barometer mean [m]
    attitude_ok: bool  # aligned in tilt and yaw
    position_ok: bool  # it is known, absolute or relative: modes that need a position may be armed
    reset_ne_count: int  # counts jumps of horizontal position/velocity, so that controllers can follow
    reset_d_count: int
    reset_yaw_count: int
    reset_pos: Vec3  # last jump of pos [m]
    reset_vel: Vec3  # last jump of vel [m/s]
    reset_yaw: float  # last jump of yaw [rad]

    @property
    @law
    def euler(self) -> Euler:
        """Roll, pitch, yaw of ``q`` [rad]."""
        return euler_of(self.q)

    @euler.setter
    def euler(self, angles: Euler | tuple[float, float, float]) -> None:
        self.q = quat_from_euler(Euler(*angles))

    @property
    @law
    def yaw(self) -> float:
        """Yaw of ``q`` [rad]."""
        return yaw_of(self.q)


class SecondLane(Record):
    """A second filter, on the other IMU, as long as the IMUs differ; ``autopilot.ekf`` is the one that is flown by."""

    runs: int  # 1: it does
    ekf: Ekf
    estimate: Estimate  # what this filter says
    lead: float  # how much better than the other it has been, 1 at most
    differ_us: int  # when the IMUs were last seen to differ


class Radio(Record):
    """The radio's channels."""

    channels: Ints = array(18, stored="i8")  # pulses in use [us]; 0 unknown
    override: Ints = array(18, stored="i8")  # 0 none
    override_us: Ints = array(18, stored="i8")  # when the override was last given
    has_receiver: bool  # a receiver is fitted
    receiver_us: int  # last good frame
    receiver_ok: bool
    override_blocked: bool  # a switch forbids overrides
    switch_position: Ints = array(RC_INPUTS, stored="u1")  # of channels with RCn_OPTION (aux_switch.py); 0 none yet
    switch_candidate: Ints = array(RC_INPUTS, stored="u1")
    switch_us: Ints = array(RC_INPUTS, stored="i8")  # since when the candidate is there
    switch_events: int  # events that the switches' functions have seen (written by the shell)
    is_faulty: bool  # SIM_RC_*:
    is_neutral: bool  # the receiver gives centred sticks and the least throttle (SIM_RC_FAIL 2)
    stuck: int  # bits of the channels that stay as they are
    noise: Float32  # of all channels, at most [us]
    noise_state: int  # of its random numbers


class HomeState(Record):
    """Home."""

    is_set: bool
    locked: bool  # set by the user: arming does not move it
    lat: int  # [degE7]
    lon: int  # [degE7]
    alt: float  # above mean sea level [m]
    pos: Vec3  # NED from the origin [m]


class BatteryState(Record):
    """What the battery monitor says."""

    voltage: float  # filtered [V]
    current: float  # [A]
    consumed_mah: float
    consumed_wh: float
    remaining_pct: float
    driver: int  # BATT_MONITOR as it was at power-on, where it is one that exists; 0 none
    healthy: bool
    healthy_us: int  # when it last was


class Arming(Record):
    """Whether the motors are armed, and what the landing and crash detectors know."""

    armed: bool
    armed_us: int  # when last armed
    auto_armed: bool  # throttle raised or take-off commanded since arming
    landed: bool
    landed_maybe: bool
    landed_ticks: int
    idle_us: int  # armed on the ground with throttle down, for DISARM_DELAY
    crash_ticks: int
    prearm_ok: bool  # SYS_STATUS health bit MAV_SYS_STATUS_PREARM_CHECK
    emergency_stop: bool  # a switch keeps the motors from turning
    interlock_used: bool  # a channel is the motor interlock
    interlock_on: bool  # and lets the motors turn
    parachute_released: bool
    accels_apart_us: int  # when accelerometers last differed too much; 0 never
    gyros_apart_us: int


class Failsafe(Record):
    """What the failsafes watch and which of them are on."""

    gcs_us: int  # last heartbeat of the ground station; 0 none so far (written by the bridge)
    gcs: bool  # failsafe is on
    radio: bool
    radio_count: int  # consecutive frames with a throttle below FS_THR_VALUE
    battery: int  # 0 none, 1 low, 2 critical
    battery_low_us: int  # since when below the low limit; 0 not
    battery_critical_us: int
    battery_missing: bool  # its monitor has failed in flight
    ekf: int  # 1 the estimate is bad
    glitch: bool  # the receiver's fixes are not believed
    ekf_count: int  # tenths of a second of bad variance
    ekf_vel: float  # filtered variances
    ekf_pos: float
    ekf_mag: float


class FollowState(Record):
    """Another vehicle, which FOLLOW follows (follow.py). NED from the origin."""

    sender: int  # its system id; 0 none received so far
    update_us: int  # its last report
    received_pos: Vec3  # of that report [m]
    received_vel: Vec3  # [m/s]
    received_acc: Vec3  # [m/s^2]
    received_heading: float  # [rad]
    received_heading_rate: float  # [rad/s]
    is_known: bool  # the motion that is followed:
    pos: Vec3  # [m]
    vel: Vec3  # [m/s]
    acc: Vec3  # [m/s^2]
    heading: float  # [rad]
    heading_rate: float  # [rad/s]
    heading_acc: float  # [rad/s^2]
    sends_more: bool  # it sends FOLLOW_TARGET: its GLOBAL_POSITION_INT is not needed
    keeps_distance: bool  # no offsets are given:
    distance: Vec3  # the position beside it is this, as FOLL_OFS_TYPE says [m]


class Modes(Record):
    """The modes: what those of all firmwares share."""

    number: int  # ArduPilot's custom mode
    shown: int  # number that clients are sent instead, 0 none (copter: AUTO_RTL, a part of AUTO)
    previous: int
    reason: int  # ArduPilot's ModeReason of the last change
    failsafe: Failsafe
    wanted: int  # a mode asks for another one: its number + 1, 0 none
    wanted_reason: int
    mission_count: int  # items of the mission, home included (written by the shell)
    mission_takes_off: bool  # its first navigation command is a take-off (written by the shell)
    mission_lands: bool  # it has a landing sequence (DO_LAND_START; written by the shell)
    mission_returns: bool  # it has a return path (DO_RETURN_PATH_START; written by the shell)
    mission_over_ground: bool  # heights of it are above the ground (written by the shell)
    follow: FollowState
    nav: Nav


PATH_POINTS = 500
"""Capacity of SMART_RTL's path; SRTL_POINTS are used."""


class PathState(Record):
    """The path that SMART_RTL goes back along (``smart_rtl_path``)."""

    active: bool  # points are recorded
    home_saved: bool
    points: int  # on the path; point 0 is home
    simplified: int  # so many from the start need no second look
    good_us: int  # last good position
    saved_us: int  # last point that found space
    reported_us: int  # when it was last said that there is little space
    n: Floats = array(PATH_POINTS, stored="f4")  # NED [m]
    e: Floats = array(PATH_POINTS, stored="f4")
    d: Floats = array(PATH_POINTS, stored="f4")
    keep: Ints = array(PATH_POINTS, stored="u1")  # for the simplification: 1 a point that stays


class Control(Record):
    """The controllers: what those of all firmwares share."""

    tick: int  # periods of the controllers since boot


class Autopilot(Record):
    """A firmware: what all firmwares share. Each has parameters, modes and controllers of its own."""

    params: Parameters
    estimate: Estimate
    ekf: Ekf
    second_lane: SecondLane
    yaw_bank: YawBank
    rc: Radio
    home: HomeState
    battery: BatteryState
    arming: Arming
    modes: Modes
    calibrated: Calibrated
    gps: GpsChoice
    baros: Barometers
    control: Control
    events: Events
    inertial: InertialRing
    inertial_filter: InertialFilter
    vibration: Vibration
    fence: FenceState
    rally: RallyState
    proximity: Proximity
    avoid: Avoidance
    objects: Objects
    flow: OpticalFlow
    odometry: VisualOdometry
    landing_target: LandingTarget


class Vehicle(Protocol):
    """What the autopilot sees of the vehicle that it flies: time, sensors, and what it writes."""

    @property
    def time_us(self) -> int:
        """Since boot [us]; only physics advances it."""

    @property
    def tick(self) -> int:
        """Ticks since boot."""

    @property
    def sensors(self) -> Sensors:
        """Border: written by physics."""

    @property
    def actuators(self) -> Actuators:
        """Border: written by the autopilot."""

    @property
    def autopilot(self) -> Autopilot:
        """The firmware."""
