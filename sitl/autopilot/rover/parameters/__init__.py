# SPDX-License-Identifier: BSD-3-Clause
"""The rover's parameters, with ArduPilot's names, defaults and order."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

from ....core.border import RC_INPUTS
from ....core.records import Floats, Records
from ... import shell_parameters
from ...params import firmware_parameters as shared
from ...params import simulation
from ...params.avoidance import Avoid, PathPlanning, Proximity, ProximitySensor
from ...params.estimator import Ekf3
from ...params.fence_parameters import Rally
from ...params.follow_parameters import Follow
from ...params.parameter import BITS32, INT8, INT16, INT32, group, numbered, param
from ...params.radio import RcChannel, RcMap
from ...params.registered import with_registered
from ...params.system import Ahrs, Arming, Compass, Inertial, Log, Mavlink, SmartRtl, Statistics, StreamRates
from ...params.table import Table
from .control import Attitude, Motors, Position, SecondEncoder, ServoOutput, WheelEncoder
from .driving import Circle, Cruise, Dock, Legs, Loiter, Manual, Mission
from .precision_landing import PrecisionLanding
from .safety import Battery, Failsafes, Fence


class Simulated(simulation.Simulated):
    """SIM_: with a steering servo."""

    SERVO_SPEED: float = param(
        0.14, 0.01, 100, "s", "Time in which the steering servo turns by 60 degrees; 0.14: the airframe's"
    )
    SERVO_DELAY: float = param(0, 0, 1, "s", "By so much the steering servo hears its commands late")
    SERVO_FILTER: float = param(0, 0, 100, "Hz", "Second-order low-pass of the steering servo's commands; 0: none")


class Parameters(shared.Parameters):
    """The rover's parameters, in the order of the wire."""

    ACRO_TURN_RATE: float = param(180.0, 0.0, 360.0, "deg/s", "Turn rate of a full steering stick")
    AHRS: Ahrs
    ARMING: Arming
    ATC: Attitude
    AVOID: Avoid = group(BEHAVE=1)
    BARO_PRIMARY: float
    BATT: Battery
    CIRC: Circle
    COMPASS: Compass
    DOCK: Dock
    CRASH_ANGLE: float = param(0, 0, 60, "deg", "Lean that counts as a crash at once; 0: none does", INT8)
    CRUISE: Cruise
    SPEED_MAX: float = param(0.0, 0.0, 30.0, "m/s", "Speed at full throttle; 0: extrapolated from CRUISE_SPEED")
    EK3: Ekf3 = group(VELNE_M_NSE=0.5, VELD_M_NSE=0.7, MAG_CAL=2)
    FENCE: Fence
    FOLL: Follow
    FRAME_CLASS: float = param(1, 1, 1, "", "1: a wheeled or tracked vehicle", INT8)
    FS: Failsafes
    GCS_PID_MASK: float = param(0, 0, 511, "", "Loops told by PID_TUNING: 1 steering, 2 speed", INT16)
    GPS1_DELAY_MS: float
    GPS2_TYPE: float
    GPS2_DELAY_MS: float
    GPS_AUTO_SWITCH: float
    GPS_PRIMARY: float
    GUID_OPTIONS: float = param(
        0, *BITS32, "", "64: positions are driven to along planned legs; else the target is shaped", INT32
    )
    INITIAL_MODE: float
    INS: Inertial = group(GYRO_FILTER=4, ACCEL_FILTER=10)
    LOG: Log = group(BITMASK=65535)
    LOIT: Loiter
    MANUAL: Manual
    MAV: Mavlink
    MAV1: StreamRates = group(RAW_SENS=1, EXT_STAT=1, RC_CHAN=1, RAW_CTRL=1, POSITION=1, EXTRA1=1, EXTRA2=1, EXTRA3=1)
    MIS: Mission = group(TOTAL=0)
    MODE: Floats = param(0, 0, 127, "", "Mode at position {n} of the mode channel", INT8, count=6)
    MODE_CH: float = param(8, 0, 16, "", "Channel that selects the mode; 0 none", INT8)
    MOT: Motors
    OA: PathPlanning
    PILOT_STEER_TYPE: float = param(
        0, 0, 3, "", "0, 2: steering turns round in reverse; 1: two paddles; 3: it does not turn round", INT8
    )
    PLND: PrecisionLanding
    PRX: Proximity
    PRX1: ProximitySensor
    PSC: Position
    RALLY: Rally = group(LIMIT_KM=0.5)
    RC: Records[RcChannel] = numbered(RcChannel, RC_INPUTS, DZ=(30, 0, 30, 30) + 12 * (0,))
    RC_OVERRIDE_TIME: float
    RC_FS_TIMEOUT: float = param(1.0, 0.1, 10.0, "s", "Silence of the receiver that counts as lost")
    RCMAP: RcMap
    RTL_SPEED: float = param(0.0, 0.0, 100.0, "m/s", "Speed of the way home; 0: WP_SPEED")
    SCHED_LOOP_RATE: float = param(50, 50, 50, "Hz", "Rate of the main loop; this firmware runs at 50 Hz only", INT16)
    SERVO: Records[ServoOutput] = numbered(ServoOutput, 4, FUNCTION=(26, 0, 70, 0))
    SIM: Simulated
    SIMPLE_TYPE: float = param(0, 0, 1, "", "Stick forwards: 0 the heading when armed, 1 north", INT8)
    SRTL: SmartRtl
    STAT: Statistics
    STICK_MIXING: float = param(0, 0, 1, "", "1: the steering stick adds to the autopilot's steering", INT8)
    TURN_RADIUS: float = param(0.9, 0.0, 100.0, "m", "Turning radius at low speed and full steering")
    WENC: WheelEncoder
    WENC2: SecondEncoder
    WP: Legs


if not TYPE_CHECKING:
    Parameters = with_registered("rover", Parameters)
TABLE = Table(Parameters, Path(__file__).with_name("ardupilot.csv"), shell_parameters.MEANINGS, shell_parameters.OWN)
