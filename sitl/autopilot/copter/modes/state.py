# SPDX-License-Identifier: BSD-3-Clause
"""The record of the flight modes, of the pilot's sticks and of the failsafes.

Positions are NED metres from the EKF origin (as ``estimate.pos``), velocities m/s, accelerations m/s^2,
angles radians.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from ....core.records import Record
from ....core.vectors import Quat, Vec2, Vec3
from ... import state as shared
from ...modes import with_states
from ..navigation.state import CopterNav


class AutoYaw(Record):
    """The heading of modes that fly by themselves."""

    mode: int  # auto_yaw.py
    yaw: float  # heading under way [rad]
    rate: float  # [rad/s]
    offset: float  # FIXED: angle still to turn, signed [rad]
    slew: float  # FIXED: greatest turn rate [rad/s], 0 no limit
    look_ahead: float  # last course flown faster than 1 m/s [rad]
    roi: Vec3  # point to look at, NED [m]
    armed: float  # heading when it was armed [rad]


class TakeoffState(Record):
    """A take-off under way."""

    target_d: float  # NED [m]
    no_nav_active: bool  # no horizontal control below no_nav_d (WP_NAVALT_MIN)
    no_nav_d: float  # NED [m]
    complete: bool
    user_active: bool  # take-off in ALT_HOLD and LOITER (PILOT_TKOFF_ALT or NAV_TAKEOFF)
    user_start_d: float  # NED [m]
    user_alt: float  # to climb [m]


class GuidedState(Record):
    """GUIDED: the set-point under way."""

    submode: int  # guided.py: TAKEOFF, POSITION, ...
    pos: Vec3  # NED [m]
    vel: Vec3  # [m/s]
    acc: Vec3  # [m/s^2]
    update_us: int  # time of the last set-point
    timed_out: bool  # the set-point under way is too old; said once
    paused: bool
    q: Quat  # ANGLE: attitude, body to NED
    rates: Vec3  # ANGLE: body rates [rad/s]
    use_attitude: bool  # ANGLE: else rates only
    climb_rate: float  # ANGLE: [m/s] up
    thrust: float  # ANGLE: 0 .. 1
    use_thrust: bool  # ANGLE: thrust instead of climb rate
    # within a mission (DO_GUIDED_LIMITS); 0: no limit
    limit_us: int  # how long
    limit_low: float  # heights over the origin [m]
    limit_high: float
    limit_distance: float  # from where it began [m]
    limit_since_us: int  # when it began
    limit_from: Vec2  # and where, NE [m]


class LoiterState(Record):
    """LOITER: what the sticks ask for, and braking."""

    acc: Vec2  # what the sticks ask, NE [m/s^2]
    predicted_acc: Vec2  # what the lean of the sticks would do, NE
    predicted_euler: Vec2  # roll, pitch that follow the sticks [rad]
    predicted_rate: Vec2  # [rad/s]
    brake_acc: float  # [m/s^2]
    brake_us: int  # when the sticks were released
    seeks_target: bool  # a switch lets it hold over a landing target
    on_target: bool  # it does


class CircleState(Record):
    """CIRCLE: what the parameters and then the pilot ask for."""

    radius: float  # [m]
    radius_set: float  # CIRCLE_RADIUS when it was last taken over [m]
    rate: float  # [rad/s], positive clockwise
    may_turn_back: bool  # the rate is zero and the roll stick was centred since: it may turn either way


class PosHoldAxis(Record):
    """POSHOLD: roll or pitch."""

    phase: int  # poshold.py: FLOWN, BRAKING, STOPPED, TAKEN_OVER
    lean: float  # wanted, without that against the wind [rad]
    held: float  # lean when the stick took over [rad]
    since_us: int  # when it began to brake, or the stick took over


class PosHoldState(Record):
    """POSHOLD."""

    roll: PosHoldAxis
    pitch: PosHoldAxis
    holding: bool  # the position controller leans it
    wind: Vec2  # acceleration of the lean that holding needs, NE [m/s^2]


class FlowHoldState(Record):
    """FLOWHOLD."""

    shown: Vec2  # flow without body rates, low-passed [rad/s]
    against_wind: Vec2  # lean that the wind needs, towards south and west [rad]
    braking: bool  # the sticks were let go, and it still moves
    brake_us: int  # when they were


class FlipState(Record):
    """FLIP."""

    phase: int  # flip.py: BEGINNING, TURNING, RECOVERING
    roll: float  # the way round: 1 right, -1 left, 0 not
    pitch: float  # 1 back, -1 forward, 0 not
    start_us: int
    level: Quat  # attitude at the start, body to NED


class DriftState(Record):
    """DRIFT."""

    side_speed: float  # that the yaw stick asks for, low-passed, right positive [m/s]
    brake: float  # 0 .. 1: how far the brake is applied


class ThrowState(Record):
    """THROW."""

    stage: int  # throw.py: DISARMED, WAITING, ...
    released_us: int  # when it last began to look like a throw; 0 not yet
    released_speed: float  # down then [m/s]
    target_d: float  # height to stop at, NED [m]
    passed_on: bool  # the next mode was asked for


class ZigZagState(Record):
    """ZIGZAG."""

    stage: int  # zigzag.py: STORING, BY_STICKS, BY_ITSELF
    a: Vec2  # NE [m]
    b: Vec2
    has_a: bool
    has_b: bool
    point: int  # last flown to
    reached_us: int  # when the end of the way was reached; 0 not yet
    sweeping: bool  # goes on from line to line
    suspended: bool  # a sweep was given back to the sticks, and may go on
    sideways: bool  # on the way to where the next line begins
    line: int  # of the sweep


class SystemIdState(Record):
    """SYSTEMID."""

    testing: bool  # the chirp runs
    holds_position: bool  # an axis of the position
    time: float  # since the mode began [s]
    value: float  # of the chirp
    frequency: float  # [rad/s]
    hold_pos: Vec2  # to hold, NE [m]
    vel: Vec2  # [m/s]
    acc: Vec2  # [m/s^2]


class AxisGains(Record):
    """Gains of one axis that AUTOTUNE changes, in the units of their parameters."""

    rate_p: float
    rate_i: float
    rate_d: float
    error_hz: float  # FLTE
    target_hz: float  # FLTT
    angle_p: float
    accel: float  # ACCEL_*_MAX


class AutotuneState(Record):
    """AUTOTUNE."""

    phase: int  # autotune_gains.py: IDLE, TUNING, ...
    axis: int  # ROLL, PITCH, YAW, YAW_D
    step: int  # autotune_rules.py
    done: int  # bits of the axes that are tuned
    count: int  # twitches of the step that succeeded, less those that failed
    ignore_next: bool
    backwards: bool  # the twitch turns to the other side
    twitching: bool  # else it levels
    came_to: int  # what the last twitch came to (autotune_rules.py); GOES_ON: that has been dealt with
    overridden_us: int  # when a stick was last out of its middle; 0 they are centred
    warned_us: int  # when it last said so
    reported_us: int  # when it last said how far it is
    levelling_us: int  # since when it levels
    level_us: int  # since when it is level
    begun_us: int  # of the twitch
    limit_us: int  # its longest duration
    scale: float  # of the greatest rate of twitches, 1 or less
    target: float  # of the twitch [rad/s] or [rad]
    start_rate: float  # in its direction [rad/s]
    start_angle: float  # [rad]
    rate: float  # filtered [rad/s]
    rate_max: float
    rate_min: float  # after the greatest
    angle_max: float  # [rad]
    angle_min: float  # after the greatest
    accel: float  # up to the greatest rate [rad/s^2]
    hold_pos: Vec2  # to come back to, NE [m]
    heading: float  # [rad]
    holds_position: bool
    roll_before: AxisGains
    pitch_before: AxisGains
    yaw_before: AxisGains
    roll: AxisGains  # found so far
    pitch: AxisGains
    yaw: AxisGains


class RtlState(Record):
    """RTL and SMART_RTL."""

    state: int  # rtl.py: CLIMB, RETURN, LOITER, FINAL_DESCENT, LANDING; smart_rtl.py: CLEAN_UP, FOLLOW, PRE_LAND
    return_d: float  # height of the way home, NED [m]
    descent_d: float  # where RTL_ALT_FINAL ends, NED [m]
    home: Vec2  # NE [m]
    loiter_us: int  # when the wait over home began


class LandState(Record):
    """LAND."""

    start_us: int
    with_position: bool
    pause: bool  # wait 4 s before descending, after a failsafe
    # on a target (precision_land.py)
    repositioned: bool  # the sticks have moved the vehicle: they choose the position
    stage: int  # DESCENDING, CLIMBING, RETURNING, GIVEN_UP
    since_us: int  # when it gave up
    tries: int  # again, so far


class AutoState(Record):
    """AUTO."""

    submode: int  # auto.py
    started: bool  # by MISSION_START, or by raising the throttle
    command: int  # count of the command that is begun (nav.command_count)
    land_state: int  # 0 flying to the position, 1 descending


class PayloadPlaceState(Record):
    """AUTO's PAYLOAD_PLACE."""

    stage: int  # payload_place.py
    limit: float  # greatest descent [m]; 0 none
    speed: float  # of the descent [m/s]
    start_d: float  # where it began, NED [m]
    established_us: int  # when it was not steady yet
    placed_us: int  # when the load did not stand yet
    thrust: float  # least one of the steady descent, 0 .. 1
    gripper: int  # NO_GRIPPER, HOLDS, OPEN: written by the gripper


class PilotState(Record):
    """The pilot's sticks and switch."""

    roll: float  # sticks with dead zone, -1 .. 1, right positive
    pitch: float  # -1 .. 1, stick back (nose up) positive
    yaw: float  # -1 .. 1, right positive
    throttle: float  # 0 .. 1, no dead zone
    throttle_filtered: float  # PILOT_THR_FILT
    yaw_rate: float  # filtered by PILOT_Y_RATE_TC [rad/s]
    switch_position: int  # of the mode channel 0 .. 5, -1 none
    switch_candidate: int
    switch_us: int  # since when the candidate is there
    rudder_us: int  # since when the yaw stick is held for arming or disarming; 0 not
    rudder_done: bool  # the stick must return before it counts again
    throttle_zero: bool  # low, for at least 0.4 s
    throttle_zero_us: int  # when last above zero
    # the lean last asked for, and what it follows from: sticks stay as they are for eight ticks and more
    lean_roll: float  # [rad]
    lean_pitch: float
    lean_of_roll: float  # sticks
    lean_of_pitch: float
    lean_of_angle: float  # at full stick [rad]
    lean_of_limit: float  # [rad]


class SimpleState(Record):
    """SIMPLE and SUPER_SIMPLE."""

    number: int  # simple.py: OFF, SIMPLE, SUPER_SIMPLE
    heading: float  # forwards in SIMPLE [rad]
    heading_from_home: float  # forwards in SUPER_SIMPLE [rad]


class LandingState(Record):
    """What the landing detector filters."""

    acc: Vec3  # acceleration NED, low-passed at 1 Hz [m/s^2]
    landing: bool  # a mode is descending to land


class Modes(shared.Modes):
    """The flight modes."""

    auto_yaw: AutoYaw
    takeoff: TakeoffState
    guided: GuidedState
    loiter: LoiterState
    circle: CircleState
    poshold: PosHoldState
    flowhold: FlowHoldState
    flip: FlipState
    drift: DriftState
    throw: ThrowState
    zigzag: ZigZagState
    systemid: SystemIdState
    autotune: AutotuneState
    rtl: RtlState
    path: shared.PathState
    land: LandState
    auto: AutoState
    pilot: PilotState
    simple: SimpleState
    landing: LandingState
    arming_delay: bool  # armed less than 2 s ago: motors wait
    nav: CopterNav
    payload_place: PayloadPlaceState


if not TYPE_CHECKING:
    Modes = with_states("copter", Modes)
