# SPDX-License-Identifier: BSD-3-Clause
"""The copter's parameters, with ArduPilot's names, defaults and order."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

from ....core.records import Floats, Records
from ... import shell_parameters
from ...params import firmware_parameters as shared
from ...params.avoidance import CopterPathPlanning, ProximitySensor
from ...params.estimator import Ekf3
from ...params.fence_parameters import Rally
from ...params.parameter import BITS32, INT8, INT16, INT32, ParameterGroup, numbered, param
from ...params.precision_landing import PrecisionLanding
from ...params.radio import RcChannel, RcMap
from ...params.registered import with_registered
from ...params.system import Ahrs, Arming, Compass, Inertial, Log, Mavlink, Mission, Statistics, StreamRates
from ...params.table import Table
from ...terrain.grid import MEANINGS
from . import flight_modes
from .avoidance import Avoid, Proximity
from .control import Attitude, Motors, Position
from .safety import Battery, Failsafes, Fence, Simulated
from .terrain_heights import TerrainData


class Frame(ParameterGroup):
    """FRAME_: arrangement of the motors."""

    TYPE: float = param(1, 0, 20, "", "0: plus, 1: X, 2: V, 3: H, ... (the motors' order)", INT8)
    CLASS: float = param(0, 0, 18, "", "1: quad, 2: hexa, 3: octa, 4: octa-quad, 5: Y6; 0: not chosen yet", INT8)


class Output(ParameterGroup):
    """SERVOn_: an output."""

    FUNCTION: float = param(
        0, -1, 300, "", "What output {n} does: 33 to 40 motor 1 to 8, 0 nothing (free for DO_SET_SERVO)", INT16
    )


class Parameters(shared.Parameters):
    """The copter's parameters, in the order of the wire."""

    ACRO: flight_modes.Acro
    ANGLE_MAX: float = param(3000, 500, 8000, "cdeg", "Greatest lean in all modes", INT16)
    AHRS: Ahrs
    ARMING: Arming
    ATC: Attitude
    AUTO_OPTIONS: float = param(
        0,
        *BITS32,
        "",
        "Bits: 1 may be armed in AUTO, 2 takes off without a raised throttle, 128 pilot may not yaw",
        INT32,
    )
    AUTOTUNE: flight_modes.Autotune
    AVOID: Avoid
    BARO_PRIMARY: float
    BATT: Battery
    CIRCLE: flight_modes.Circle
    COMPASS: Compass
    DISARM_DELAY: float = param(
        10, 0, 127, "s", "Armed on the ground with the throttle low for so long: disarms; 0 never", INT8
    )
    EK3: Ekf3
    FENCE: Fence
    FHLD: flight_modes.FlowHold
    FLIGHT_OPTIONS: float = param(
        0,
        *BITS32,
        "",
        "Bits: 1 does not look for a loss of thrust, 2 for yaw imbalance, 4 opens the gripper when thrust is lost",
        INT32,
    )
    FLTMODE: Floats = param(0, 0, 127, "", "Mode at position {n} of the mode channel", INT8, count=6)
    FLTMODE_CH: float = param(5, 0, 16, "", "Channel that selects the mode; 0 none", INT8)
    FOLL: flight_modes.Follow
    FRAME: Frame
    FS: Failsafes
    GCS_PID_MASK: float = param(0, 0, 511, "", "Loops told by PID_TUNING: 1 roll, 2 pitch, 4 yaw, 8 vertical", INT16)
    GPS1_DELAY_MS: float
    GPS2_TYPE: float
    GPS2_DELAY_MS: float
    GPS_AUTO_SWITCH: float
    GPS_PRIMARY: float
    GUID: flight_modes.Guided
    INITIAL_MODE: float
    INS: Inertial
    LAND: flight_modes.Land
    LOG: Log
    LOIT: flight_modes.Loiter
    MAV: Mavlink
    MAV1: StreamRates
    MIS: Mission
    MOT: Motors
    OA: CopterPathPlanning
    PHLD: flight_modes.PosHold
    PILOT: flight_modes.Pilot
    PLDP: flight_modes.PayloadPlace
    PLND: PrecisionLanding
    PRX: Proximity
    PRX1: ProximitySensor
    PSC: Position
    RALLY: Rally
    RC: Records[RcChannel]
    RC_OVERRIDE_TIME: float
    RC_FS_TIMEOUT: float = param(1.0, 0.5, 10.0, "s", "Silence of the receiver that counts as lost")
    RCMAP: RcMap
    RPM1_TYPE: float = param(
        0, 0, 5, "", "RPM message: 0 none, 5 mean speed of the motors as told by their controllers", INT8
    )
    RTL: flight_modes.Rtl
    SCHED_LOOP_RATE: float = param(
        400.0, 400.0, 400.0, "Hz", "Rate of the main loop; this firmware runs at 400 Hz only", INT16
    )
    SERVO: Records[Output] = numbered(Output, 16)
    SID: flight_modes.SystemId
    SIM: Simulated
    SIMPLE: float = param(0, 0, 63, "", "Bit n: SIMPLE at position n + 1 of the mode channel", INT8)
    SRTL: flight_modes.SmartRtl
    STAT: Statistics
    SUPER_SIMPLE: float = param(0, 0, 63, "", "Bit n: SUPER_SIMPLE at position n + 1 of the mode channel", INT8)
    TERRAIN: TerrainData
    THR_DZ: float = param(
        100,
        0,
        300,
        "us",
        "Half of the dead zone around the middle, in thousandths of the stick, in modes that hold height",
        INT16,
    )
    THROW: flight_modes.Throw
    TKOFF: flight_modes.TakeOff
    WP: flight_modes.Waypoints
    WPNAV: flight_modes.Legs
    ZIGZ: flight_modes.ZigZag


if not TYPE_CHECKING:
    Parameters = with_registered("copter", Parameters)
TABLE = Table(
    Parameters,
    Path(__file__).with_name("ardupilot.csv"),
    {**shell_parameters.MEANINGS, **MEANINGS},
    shell_parameters.OWN,
)
