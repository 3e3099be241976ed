# SPDX-License-Identifier: BSD-3-Clause
"""The decisions of one period of 20 ms: sticks, mode, crash check, failsafes."""

from __future__ import annotations

from ....core.algebra import dot2, horizontal, with_down
from ....core.kernels import law, unit
from ....core.records import Records
from ....core.vectors import Vec3
from ... import aux_switch, battery, home, optical_flow, smart_rtl_path, visual_odometry
from ...arming_checks import ArmingMethod
from ...avoidance import bendy_ruler, limit, proximity
from ...events import Events, emit_and_return
from ...failsafe_checks import battery_fell_to, is_gcs_lost, is_radio_bad, report_battery, watch_monitor
from ...mode_switch import is_rudder_held, moved_to
from ...modes import ModeReason, take_asked
from ...navigation.path import areas_of, watch_detour
from ...navigation.state import DETOUR_REQUEST, GO_ON, LEG_ENDING
from ...params.system import SmartRtl
from ...state import Estimate, HomeState
from .. import crash, failsafe, fence, motor_test, pilot
from ..arming import set_disarmed, stick_command, try_arm
from ..arming_checks import check
from ..control.forward_speed import sense
from ..control.motors import is_moving
from ..state import Vehicle
from . import mode_list, set_mode
from .smart_rtl import SMART_RTL
from .state import BIT_GCS, BIT_RADIO, Modes

# Ticks of 2.5 ms; all are multiples of the 8 of a period
_TENTH = 40
_QUARTER = 104
_THIRD = 136
_SECOND = 400

HOME_MOVES = 0.5
"""Disarmed, home follows a vehicle that is further from it [m]."""


def init(v: Vehicle) -> None:
    """At boot, on a record of zeros with parameters set: disarmed, in the first mode."""
    ap = v.autopilot
    set_mode.enter_first(v)
    ap.arming.landed = True
    battery.power_on(ap.battery, ap.params.BATT)
    pilot.init(ap.modes.pilot, ap.rc)
    proximity.power_on(ap.proximity, ap.params.PRX1)
    optical_flow.power_on(ap.flow, ap.params.FLOW)
    visual_odometry.power_on(ap.odometry, ap.params.VISO)


@unit
def update(fleet: Records[Vehicle], i: int) -> None:
    """One period of vehicle ``i``: reads the estimate, writes demands of steering and throttle."""
    v = fleet[i]
    ap, tick = v.autopilot, v.tick
    modes = ap.modes
    sense(ap.control.speed, ap.estimate, v.sensors, v.time_us)
    read_transmitter(v)
    if tick % _TENTH == 0:
        check_slowly(v)
    if tick % _QUARTER == 0:
        ap.arming.prearm_ok = ap.arming.armed or check(v) == 0
    if tick % _THIRD == 0:
        keep_path(modes, ap.estimate, ap.events, v.time_us, ap.params.SRTL)
    if tick % _SECOND == 0:
        follow_home(ap.home, ap.estimate, ap.arming.armed)
    mode_list.run(modes.number, v)
    if modes.nav.request_pending == GO_ON:
        emit_and_return(ap.events, v.time_us, LEG_ENDING, DETOUR_REQUEST, 0.0)
    wanted = take_asked(modes)
    if wanted >= 0:
        set_mode.request(v, wanted, modes.wanted_reason)
    motor_test.control(ap.control.motors, ap.arming, ap.events, v.time_us)


@law
def read_transmitter(v: Vehicle) -> None:
    """50 times a second: sticks, whether the radio is there, mode switch, arming by stick."""
    ap = v.autopilot
    sticks, modes, p = ap.modes.pilot, ap.modes, ap.params
    pilot.read(sticks, ap.rc, v.sensors, p, v.time_us)
    lost = p.FS.THR_ENABLE > 0.0 and is_radio_bad(ap.rc, p.RCMAP, p.FS.THR_VALUE)
    modes.failsafe.radio = lost
    sticks.lost = lost or not ap.rc.receiver_ok
    failsafe.watch(v, BIT_RADIO, lost)
    if not lost:
        now = moved_to(sticks, ap.rc, int(p.MODE_CH), v.time_us)
        if now >= 0:
            set_mode.request(v, int(p.MODE[now]), ModeReason.RC)
        aux_switch.watch(ap.rc, ap.arming, ap.events, v.time_us, p)
    armed = ap.arming.armed
    moving = is_moving(ap.control.motors, armed, p)
    command = stick_command(sticks, modes.number, armed, moving, p.ARMING.RUDDER)
    if is_rudder_held(sticks, command, v.time_us):
        sticks.rudder_us = 0
        if command > 0:
            try_arm(v, ArmingMethod.RUDDER, False)
        else:
            set_disarmed(ap.arming, ap.events, v.time_us, ArmingMethod.RUDDER)


@law
def check_slowly(v: Vehicle) -> None:
    """Ten times a second: battery, ground station, estimate, crash."""
    ap = v.autopilot
    fs, p = ap.modes.failsafe, ap.params
    battery.monitor(ap.battery, v.sensors, p.BATT, v.time_us)
    fs.gcs = is_gcs_lost(fs, v.time_us, p.FS)
    failsafe.watch(v, BIT_GCS, fs.gcs)
    level = battery_fell_to(fs, ap.battery, ap.arming.armed, v.time_us, p.BATT)
    report_battery(ap.events, v.time_us, level, ap.battery)
    watch_monitor(fs, ap.battery, ap.arming.armed, ap.events, v.time_us)
    failsafe.act(v, failsafe.battery_action(level, p.BATT), ModeReason.BATTERY_FAILSAFE)
    failsafe.check_ekf(v)
    fence.watch(v)
    crash.check(v)
    limit.watch(v, False)
    bendy_ruler.watch(ap, 0.0, False, v.time_us)
    watch_detour(ap.modes.nav, areas_of(ap.fence, p.OA, p.FENCE), ap.events, v.time_us)


@law
def keep_path(modes: Modes, estimate: Estimate, events: Events, time_us: int, params: SmartRtl) -> None:
    """Three times a second: the path of SMART_RTL begins with the first position, and grows unless on the way back."""
    pos, position_ok = with_down(horizontal(estimate.pos), 0.0), estimate.position_ok
    if not modes.path.home_saved and position_ok:
        smart_rtl_path.begin(modes.path, pos, True, time_us, params)
    if modes.number != SMART_RTL:
        smart_rtl_path.record(modes.path, pos, position_ok, events, time_us, params)


@law
def is_away(pos: Vec3, home_pos: Vec3) -> bool:
    """Whether the vehicle is so far from home that home moves, both NED [m]."""
    away = horizontal(pos) - horizontal(home_pos)
    return dot2(away, away) >= HOME_MOVES * HOME_MOVES


@law
def follow_home(state: HomeState, estimate: Estimate, armed: bool) -> None:
    """Once a second: home is set with the first position; disarmed it moves with the vehicle, unless locked."""
    if not state.is_set:
        home.set_first(state, estimate)
    elif not (armed or state.locked) and estimate.position_ok:
        if is_away(estimate.pos, state.pos):
            home.set_here(state, estimate)
