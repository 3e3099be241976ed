# SPDX-License-Identifier: BSD-3-Clause
"""The record of the rover's modes, of the pilot's sticks and of the failsafes.

Positions are NE metres from the EKF origin (as ``estimate.pos``), velocities m/s, angles radians; steering and throttle
-1 .. 1, right and forward positive.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from ....core.records import Record
from ....core.vectors import Vec2
from ... import state as shared
from ...modes import with_states
from ..navigation.state import RoverNav


class GuidedState(Record):
    """GUIDED: the set-point under way."""

    submode: int  # guided.py: STOP, POSITION, HEADING_AND_SPEED, ...
    pos: Vec2  # POSITION [m]
    heading: float  # HEADING_AND_SPEED [rad]
    turn_rate: float  # TURN_RATE_AND_SPEED [rad/s]
    speed: float  # of both, backward negative [m/s]
    update_us: int  # when the last set-point came
    has_target: bool  # the set-point under way is fresh enough; else it stops
    arrival_reported: bool  # POSITION: arrival was said
    limit_us: int  # guided within a mission ends after so long; 0 never
    limit_distance: float  # and so far from where it began [m]; 0 never
    limit_since_us: int  # when it began
    limit_from: Vec2  # where [m]


class LoiterState(Record):
    """LOITER."""

    hold_pos: Vec2  # [m]
    heading: float  # [rad]
    speed: float  # [m/s]
    distance: float  # to the position [m]


class CircleState(Record):
    """CIRCLE."""

    centre: Vec2  # [m]
    radius: float  # [m]
    direction: float  # 1 clockwise, -1 counter-clockwise
    speed: float  # wanted [m/s]
    angle: float  # of the target, seen from the centre [rad]
    target: Vec2  # [m]
    target_speed: float  # [m/s]
    total: float  # turned so far, signed [rad]
    at_edge: bool  # else still on the way there
    waiting: bool  # the vehicle fell behind: the target waits for it


class DockState(Record):
    """DOCK."""

    pos: Vec2  # the dock, as last seen [m]
    distance: float  # from it [m]
    done: bool  # it is there


class SimpleState(Record):
    """SIMPLE."""

    first_heading: float  # when armed [rad]
    heading: float  # last asked for [rad]


class RtlState(Record):
    """RTL."""

    is_reported: bool  # arrival was said


class SmartRtlState(Record):
    """SMART_RTL."""

    state: int  # smart_rtl.py: CLEAN_UP, FOLLOW, ARRIVED


class AutoState(Record):
    """AUTO."""

    submode: int  # what AUTO is doing (auto.py: STOPPED, ON_PATH, ...)
    command: int  # count of the command that is begun (nav.command_count)
    heading: float  # SET_YAW_SPEED [rad]
    speed: float  # backward negative [m/s]
    heading_reached: bool
    complete: bool  # what comes after the mission has begun (MIS_DONE_BEHAVE)


class PilotState(Record):
    """The pilot's sticks and switch."""

    lost: bool  # the radio is: the sticks say nothing
    steering: float  # stick with dead zone, right positive
    throttle: float
    steering_pulse: float  # how far the steering stick's pulse is from the middle, at most half its travel [us]
    left: float  # the same sticks as the paddles of a tank, without dead zone
    right: float
    switch_position: int  # of the mode channel 0 .. 5, -1 none
    switch_candidate: int
    switch_us: int  # since when the candidate is there
    rudder_us: int  # since when the steering stick is held for arming or disarming; 0 not


BIT_RADIO, BIT_GCS = 1, 2
"""Bits of ``LinksState``."""


class LinksState(Record):
    """Radio and ground station, as the failsafe sees them."""

    bad: int  # BIT_RADIO, BIT_GCS
    since_us: int  # when the first of them was lost
    acted: int  # bits for which FS_ACTION was done


class Modes(shared.Modes):
    """The driving modes."""

    guided: GuidedState
    loiter: LoiterState
    circle: CircleState
    dock: DockState
    simple: SimpleState
    rtl: RtlState
    path: shared.PathState
    smart_rtl: SmartRtlState
    auto: AutoState
    pilot: PilotState
    links: LinksState
    ekf_was_good: bool  # while armed, since boot
    nav: RoverNav


if not TYPE_CHECKING:
    Modes = with_states("rover", Modes)
