# SPDX-License-Identifier: BSD-3-Clause
"""Parameters of the copter's modes: sticks, legs, take-off, return, landing."""

from __future__ import annotations

from ...params import follow_parameters, system
from ...params.parameter import BITS16, BITS32, INT8, INT16, INT32, ParameterGroup, param


class Acro(ParameterGroup):
    """ACRO_: rates and trainer of ACRO."""

    BAL_ROLL: float = param(1.0, 0.0, 3.0, "1/s", "Roll turns back to level at so many times its lean")
    BAL_PITCH: float = param(1.0, 0.0, 3.0, "1/s", "Pitch turns back to level at so many times its lean")
    TRAINER: float = param(
        2, 0, 2, "", "0: none, 1: levels with the sticks centred, 2: levels and limits the lean", INT8
    )
    THR_MID: float = param(0.0, 0.0, 1.0, "", "Throttle in the middle of the stick; 0: that of hovering")
    RP_RATE: float = param(360.0, 1.0, 1080.0, "deg/s", "Roll and pitch rate at full stick")
    RP_EXPO: float = param(0.3, -0.5, 0.95, "", "Softness of the roll and pitch sticks around the middle")
    Y_RATE: float = param(202.5, 1.0, 360.0, "deg/s", "Yaw rate at full stick")
    Y_EXPO: float = param(0.0, -1.0, 1.0, "", "Softness of the yaw stick around the middle")


class Circle(ParameterGroup):
    """CIRCLE_: circles."""

    RADIUS: float = param(1000.0, 0.0, 200000.0, "cm", "Radius when a mission gives none")
    RATE: float = param(20.0, -90.0, 90.0, "deg/s", "Greatest turn rate around the circle")
    OPTIONS: float = param(
        1,
        *BITS16,
        "",
        "CIRCLE: 1 sticks change radius and rate, 2 the nose points along the circle, 4 around where it is",
        INT16,
    )


class Guided(ParameterGroup):
    """GUID_: GUIDED."""

    OPTIONS: float = param(
        0, *BITS32, "", "1 armed by the transmitter, 4 ignores the yaw stick, 8 SET_ATTITUDE_TARGET has thrust", INT32
    )
    TIMEOUT: float = param(3.0, 0.1, 3600.0, "s", "Velocity, acceleration and attitude set-points are good for so long")


class Land(ParameterGroup):
    """LAND_: LAND."""

    SPEED: float = param(50, 10, 500, "cm/s", "Last part of the descent", INT16)
    SPEED_HIGH: float = param(0, 0, 1000, "cm/s", "Descent above LAND_ALT_LOW; 0 as WPNAV_SPEED_DN", INT16)
    ALT_LOW: float = param(1000, 100, 10000, "cm", "Height where the descent slows down to LAND_SPEED", INT16)
    REPOSITION: float = param(1, 0, 1, "", "The pilot may move the landing place", INT8)


class PayloadPlace(ParameterGroup):
    """PLDP_: AUTO's PAYLOAD_PLACE."""

    THRESH: float = param(0.9, 0.0, 1.0, "", "The load stands when less than this part of the descent's thrust is left")
    RNG_MAX: float = param(0.0, 0.0, 100.0, "m", "And the rangefinder reads less than this; 0: it is not asked")
    DELAY: float = param(0.0, 0.0, 120.0, "s", "Wait between release and climb")
    SPEED_DN: float = param(0.0, 0.0, 5.0, "m/s", "Descent; 0 as LAND_SPEED")


class Loiter(ParameterGroup):
    """LOIT_: LOITER."""

    ANG_MAX: float = param(
        0.0, 0.0, 45.0, "deg", "Greatest lean of the sticks; 0 is two thirds of PSC_ANGLE_MAX or ANGLE_MAX"
    )
    SPEED: float = param(1250.0, 20.0, 3500.0, "cm/s", "Greatest speed")
    ACC_MAX: float = param(500.0, 100.0, 981.0, "cm/s/s", "Greatest acceleration of the position correction")
    BRK_ACCEL: float = param(250.0, 25.0, 2500.0, "cm/s/s", "Greatest deceleration with sticks centred")
    BRK_JERK: float = param(500.0, 50.0, 10000.0, "cm/s/s/s", "Jerk of the braking")
    BRK_DELAY: float = param(1.0, 0.0, 10.0, "s", "From centring the sticks to braking")
    OPTIONS: float = param(1, 0, 1, "", "Bit 0: the velocity turns with the heading (coordinated turn)", INT8)


class Pilot(ParameterGroup):
    """PILOT_: the pilot's sticks."""

    THR_FILT: float = param(0.0, 0.0, 10.0, "Hz", "Low-pass of the throttle in STABILIZE; 0 none")
    TKOFF_ALT: float = param(0.0, 0.0, 1000.0, "cm", "Height of a take-off by stick")
    THR_BHV: float = param(
        0,
        0,
        7,
        "",
        "Bits: 1 throttle stick springs to the middle, 2 high throttle cancels LAND, 4 disarms on landing",
        INT16,
    )
    SPEED_UP: float = param(250, 10, 5000, "cm/s", "Climb rate at full stick", INT16)
    SPEED_DN: float = param(0, 0, 5000, "cm/s", "Descent at full stick; 0 as PILOT_SPEED_UP", INT16)
    ACCEL_Z: float = param(250, 10, 5000, "cm/s/s", "Vertical acceleration under the stick", INT16)
    Y_RATE: float = param(202.5, 1.0, 360.0, "deg/s", "Turn rate at full stick")
    Y_EXPO: float = param(0.0, -0.5, 1.0, "", "Softness of the yaw stick around the middle")
    Y_RATE_TC: float = param(0.0, 0.0, 1.0, "s", "Time constant of the yaw stick")


class PosHold(ParameterGroup):
    """PHLD_: POSHOLD."""

    BRAKE_RATE: float = param(8, 1, 100, "deg/s", "How fast it leans back to stop", INT16)
    BRAKE_ANGLE: float = param(3000, 100, 8000, "cdeg", "Greatest lean that stops it", INT16)


class FlowHold(ParameterGroup):
    """FHLD_: FLOWHOLD."""

    XY_P: float = param(0.2, 0.0, 10.0, "", "Lean against a speed of 1 m/s, as share of ANGLE_MAX")
    XY_I: float = param(0.3, 0.0, 10.0, "", "How much this grows in a second")
    XY_IMAX: float = param(3000, 0, 8000, "cdeg", "Greatest lean that has grown")
    FLOW_MAX: float = param(0.6, 0.1, 2.5, "rad/s", "Greatest flow that counts")
    FILT_HZ: float = param(5.0, 0.5, 100.0, "Hz", "Low-pass of the flow")
    QUAL_MIN: float = param(10, 0, 127, "", "Least quality of a flow that is believed", INT8)
    BRAKE_RATE: float = param(8, 1, 30, "deg/s", "How hard it leans back to stop", INT8)


class Rtl(ParameterGroup):
    """RTL_: RTL."""

    ALT: float = param(1500, 0, 300000, "cm", "Height of the way home, above home", INT32)
    ALT_FINAL: float = param(0, 0, 32767, "cm", "Height over home where it stays; 0 lands", INT16)
    CLIMB_MIN: float = param(0, 0, 3000, "cm", "Least climb before the way home", INT16)
    CONE_SLOPE: float = param(
        3.0, 0.0, 10.0, "", "Near home it climbs no higher than distance times this; below 0.5 off"
    )
    SPEED: float = param(0, 0, 2000, "cm/s", "Speed of the way home; 0 as WPNAV_SPEED", INT16)
    LOIT_TIME: float = param(5000, 0, 60000, "ms", "Wait over home", INT32)
    ALT_TYPE: float = param(0, 0, 1, "", "Height of the way home: 0 above home, 1 above the ground", INT8)
    OPTIONS: float = param(0, *BITS32, "", "4: the yaw stick does nothing on the way home", INT32)


class SmartRtl(system.SmartRtl):
    """SRTL_: SMART_RTL, and its path."""

    OPTIONS: float = param(0, *BITS32, "", "4: the yaw stick does nothing on the way back", INT32)


class Follow(follow_parameters.Follow):
    """FOLL_: with what only a vehicle in the air has."""

    YAW_BEHAVE: float = param(
        1, 0, 3, "", "Heading: 0 kept, 1 towards the lead, 2 the lead's, 3 along its course", INT8
    )
    ALT_TYPE: float = param(1, 0, 2, "", "The lead's height: 0 and 2 above the sea, 1 above home", INT8)


class TakeOff(ParameterGroup):
    """TKOFF_: take-off."""

    SLEW_TIME: float = param(2.0, 0.25, 5.0, "s", "From zero to full throttle on the ground")
    RPM_MIN: float = param(
        0, 0, 10000, "RPM", "Motors that turn slower keep the vehicle on the ground; 0: no check", INT16
    )
    THR_MAX: float = param(0.9, 0.0, 0.9, "", "Throttle at which it is taken to fly")
    RPM_MAX: float = param(0, 0, 10000, "RPM", "Motors that turn faster do, too; 0: no limit", INT16)


class Throw(ParameterGroup):
    """THROW_: THROW."""

    MOT_START: float = param(0, 0, 1, "", "Motors before the throw: 0 off, 1 idle", INT8)
    ALT_MIN: float = param(0, 0, 32767, "m", "Least height above home of a throw; 0 any", INT16)
    ALT_MAX: float = param(0, 0, 32767, "m", "Greatest height above home of a throw; 0 any", INT16)
    ALT_DCSND: float = param(1.0, 0.0, 50.0, "m", "Dropped, it stops so far below where it was upright")
    ALT_ACSND: float = param(3.0, 0.0, 50.0, "m", "Thrown, it stops so far above where it was upright")
    NEXTMODE: float = param(
        18, 0, 127, "", "Then: 3 AUTO, 4 GUIDED, 5 LOITER, 6 RTL, 9 LAND, 17 BRAKE, else THROW", INT8
    )
    TYPE: float = param(0, 0, 1, "", "0 thrown upwards, 1 dropped", INT8)


class Autotune(ParameterGroup):
    """AUTOTUNE_: AUTOTUNE."""

    AXES: float = param(7, 0, 15, "", "Bits: 1 roll, 2 pitch, 4 yaw's error filter, 8 yaw's D", INT8)
    AGGR: float = param(0.075, 0.05, 0.1, "", "Bounce that is taken for one, as a part of the greatest rate")
    MIN_D: float = param(0.0005, 0.0001, 0.005, "", "Least gain of the derivative")


class SystemId(ParameterGroup):
    """SID_: the chirp of SYSTEMID."""

    AXIS: float = param(
        0,
        0,
        19,
        "",
        "Added to: 1-3 lean, turn; 4-6 the same, no feed-forward; 7-9 rates; 10-13 motors; 14-19 position; 0: refused",
        INT8,
    )
    MAGNITUDE: float = param(15.0, -1000.0, 1000.0, "", "Size of the chirp, in the unit of its axis")
    F_START_HZ: float = param(0.5, 0.0, 100.0, "Hz", "Frequency at its start")
    F_STOP_HZ: float = param(40.0, 0.0, 100.0, "Hz", "Frequency at its end")
    T_FADE_IN: float = param(15.0, 0.0, 1000.0, "s", "Time in which it becomes full")
    T_REC: float = param(70.0, 0.0, 1000.0, "s", "Length of the chirp")
    T_FADE_OUT: float = param(2.0, 0.0, 1000.0, "s", "Time in which it vanishes at its end")


class Waypoints(ParameterGroup):
    """WP_: heading at waypoints, height without navigation."""

    YAW_BEHAVIOR: float = param(
        2, 0, 3, "", "Heading: 0 kept, 1 to the next waypoint, 2 the same but kept in RTL, 3 along the course", INT8
    )
    NAVALT_MIN: float = param(0.0, 0.0, 5.0, "m", "No leaning below this height in take-off and landing")


class ZigZag(ParameterGroup):
    """ZIGZ_: ZIGZAG."""

    AUTO_ENABLE: float = param(0, 0, 1, "", "1: function 83 of a switch sweeps from line to line", INT8)
    WP_DELAY: float = param(0, 0, 127, "s", "Wait at the end of each line", INT8)
    SIDE_DIST: float = param(4.0, 0.1, 100.0, "m", "Distance of the lines of a sweep")
    DIRECTION: float = param(0, 0, 3, "", "Side of a sweep: 0 forward, 1 right, 2 backward, 3 left of the nose", INT8)
    LINE_NUM: float = param(0, -1, 32767, "", "Lines of a sweep; 0: one way sideways only, -1: no end", INT16)


class Legs(ParameterGroup):
    """WPNAV_: flight along legs."""

    SPEED: float = param(1000.0, 10.0, 10000.0, "cm/s", "Horizontal speed limit in missions")
    RADIUS: float = param(200.0, 5.0, 1000.0, "cm", "Distance at which a waypoint is reached")
    SPEED_UP: float = param(250.0, 10.0, 5000.0, "cm/s", "Climb speed limit in missions")
    SPEED_DN: float = param(150.0, 10.0, 2000.0, "cm/s", "Descent speed limit in missions")
    ACCEL: float = param(250.0, 50.0, 2000.0, "cm/s/s", "Horizontal acceleration limit in missions")
    ACCEL_Z: float = param(100.0, 50.0, 1000.0, "cm/s/s", "Vertical acceleration limit in missions")
    JERK: float = param(1.0, 0.1, 50.0, "m/s/s/s", "Jerk limit along legs")
    ACCEL_C: float = param(0.0, 0.0, 2000.0, "cm/s/s", "Acceleration in corners; 0: twice WPNAV_ACCEL")
    RFND_USE: float = param(1, 0, 1, "", "1: heights above the ground are by a range-finder, where there is one", INT8)
