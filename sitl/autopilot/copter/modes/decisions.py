# SPDX-License-Identifier: BSD-3-Clause
"""The decisions of one tick: sticks, mode, landing and crash detection, failsafes."""

from __future__ import annotations

from ....core.kernels import inlined, law, unit
from ....core.records import Records
from ... import battery, home, optical_flow, visual_odometry
from ...avoidance import bendy_ruler, proximity
from ...events import emit_and_return
from ...modes import ModeReason, take_asked
from ...navigation.path import areas_of, watch_detour
from ...navigation.state import DETOUR_REQUEST, GO_ON, LEG_ENDING
from ...radio import RC_TICKS
from ...state import Arming
from ...terrain.ground import watch_square
from .. import (
    arming,
    avoidance,
    crash,
    failsafe,
    fence,
    landing,
    motor_test,
    pilot,
    takeoff_check,
    terrain_following,
    thrust_loss,
    yaw_imbalance,
)
from ..control.motors import learn_hover_throttle
from ..control.spool import DesiredSpoolState
from ..control.state import DT, Control
from ..state import Vehicle
from . import mode_list, set_mode, simple, smart_rtl, switch
from .auto import is_guided
from .drift import DRIFT
from .stabilize import STABILIZE
from .state import Modes

_TENTH = 40  # ticks
_QUARTER = 100
_THIRD = 133
_LEARN_TICKS = 4
_LEARN_COS_LEAN = 0.9962  # 5 degrees
_LEARN_SPEED = 0.6  # [m/s]
_SLOW_PATH = 0.01  # [m/s]
_AT_REST = 1.2e-7  # [m/s] what ArduPilot takes for 0


def init(v: Vehicle) -> None:
    """At boot, on a record of zeros with parameters set: on the ground, disarmed, in INITIAL_MODE."""
    ap = v.autopilot
    number = int(ap.params.INITIAL_MODE)
    ap.modes.number = number if mode_list.is_known(number) else STABILIZE
    ap.modes.previous = ap.modes.number
    ap.modes.reason = ModeReason.INITIALISED
    ap.arming.landed = True
    ap.arming.landed_maybe = True
    battery.power_on(ap.battery, ap.params.BATT)
    pilot.init(ap.rc, ap.modes.pilot)
    proximity.power_on(ap.proximity, ap.params.PRX1)
    optical_flow.power_on(ap.flow, ap.params.FLOW)
    visual_odometry.power_on(ap.odometry, ap.params.VISO)


@unit
def update(fleet: Records[Vehicle], i: int) -> None:
    """One tick of vehicle ``i``: reads the estimate, writes targets of the controllers."""
    v = fleet[i]
    ap = v.autopilot
    tick = v.tick
    if tick % RC_TICKS == 0:
        read_transmitter(v)
    if tick % _TENTH == 4:
        check_slowly(v)
    if tick % fence.TICKS == 8:
        fence.watch(v)
    if tick % _QUARTER == 12:
        home.set_first(ap.home, ap.estimate)
        ap.arming.prearm_ok = arming.check(v) == 0
    if tick % _THIRD == 36:
        smart_rtl.record(v)
    arming.follow_throttle(ap.arming, ap.modes, v.time_us)
    run_mode(v)
    motor_test.run(v)
    landing.detect(v)
    crash.check(v)
    thrust_loss.check(v)
    landing.set_priority(ap.control, ap.arming, ap.modes, ap.estimate.vel.z, ap.params.ATC)
    if tick % _LEARN_TICKS == 0 and holds_height(ap.arming, ap.modes) and hovers(ap.control, ap.estimate.vel.z):
        learn_hover_throttle(ap.params.MOT, ap.control.motors.throttle, _LEARN_TICKS * DT)


@law
def read_transmitter(v: Vehicle) -> None:
    """50 times a second."""
    pilot.read(v)
    turn_sticks(v)
    failsafe.watch_radio(v)
    switch.read_switches(v)
    switch.read_rudder(v)


@law
def turn_sticks(v: Vehicle) -> None:
    """SIMPLE and SUPER_SIMPLE."""
    ap = v.autopilot
    if ap.estimate.position_ok and ap.home.is_set:
        simple.look_from_home(ap.modes.simple, ap.estimate.pos, ap.home.pos)
    # OFF costs no yaw
    if ap.modes.simple.number != simple.OFF and not mode_list.ignores_simple(ap.modes.number):
        simple.turn_sticks(ap.modes.pilot, ap.modes.simple, ap.estimate.yaw)


@law
def check_slowly(v: Vehicle) -> None:
    """Ten times a second."""
    battery.monitor(v.autopilot.battery, v.sensors, v.autopilot.params.BATT, v.time_us)
    failsafe.watch_gcs(v)
    failsafe.watch_battery(v)
    failsafe.watch_estimate(v)
    failsafe.watch_vibration(v)
    watch_terrain(v)
    arming.disarm_idle(v)
    takeoff_check.check(v)
    yaw_imbalance.check(v)
    avoidance.watch(v)
    ap, nav = v.autopilot, v.autopilot.modes.nav
    ground_d = nav.ground_d if nav.over_ground else 0.0
    bendy_ruler.watch(ap, ground_d, ap.params.OA.BR_TYPE == 2.0, v.time_us)
    watch_detour(ap.modes.nav, areas_of(ap.fence, ap.params.OA, ap.params.FENCE), ap.events, v.time_us)


@law
def watch_terrain(v: Vehicle) -> None:
    """Ten times a second: the square of the grid of heights, and heights that are missing."""
    ap = v.autopilot
    watch_square(ap.terrain, ap.estimate.pos, ap.events, v.time_us)
    failsafe.watch_terrain(v)


@inlined
def run_mode(v: Vehicle) -> None:
    """The mode's own tick, then the change that it may have asked for."""
    ap = v.autopilot
    if ap.modes.nav.over_ground and not is_guided(ap.modes):
        terrain_following.follow(v)
    mode_list.run(ap.modes.number, v)
    if ap.modes.nav.request_pending == GO_ON:
        emit_and_return(ap.events, v.time_us, LEG_ENDING, DETOUR_REQUEST, 0.0)
    wanted = take_asked(ap.modes)
    if wanted >= 0:
        set_mode.request(v, wanted, ap.modes.wanted_reason)
    if not ap.arming.armed or ap.modes.arming_delay:
        ap.control.motors.desired_spool = DesiredSpoolState.SHUT_DOWN


@inlined
def holds_height(arming: Arming, modes: Modes) -> bool:
    """Whether the vehicle flies in a mode that holds height, and is not taking off."""
    by_stick = mode_list.has_manual_throttle(modes.number) or modes.number == DRIFT
    flies = arming.armed and not arming.landed and not by_stick
    return flies and not landing.is_taking_off(modes)


@inlined
def hovers(control: Control, vel_d: float) -> bool:
    """Whether a vehicle that holds height hovers level: its throttle is the hover throttle; ``vel_d``: down [m/s]."""
    slow = _AT_REST if control.motors.learns_at_rest else _SLOW_PATH
    if abs(control.pos_d.vel_desired) > slow or abs(vel_d) >= _LEARN_SPEED:
        return False
    return control.attitude.cos_lean >= _LEARN_COS_LEAN and control.motors.throttle > 0.0
