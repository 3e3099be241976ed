# SPDX-License-Identifier: BSD-3-Clause
"""The decisions of one period of 20 ms: sticks, mode, crash check, failsafes."""

from __future__ import annotations

from ....core.algebra import dot2, horizontal
from ....core.kernels import law, unit
from ....core.records import Records
from ....core.vectors import Vec3
from ... import battery, home
from .. import arming, crash, failsafe, motor_test, pilot, smart_rtl_path
from ..control.forward_speed import sense
from ..state import Vehicle
from . import set_mode, switch, table
from .smart_rtl import SMART_RTL

# Ticks of 2.5 ms; all are multiples of the 8 of a period
_TENTH = 40
_QUARTER = 104
_THIRD = 136
_SECOND = 400

HOME_MOVES = 0.5
"""Disarmed, home follows a vehicle that is further from it [m]."""


@law
def init(v: Vehicle) -> None:
    """At boot, on a record of zeros with parameters set: disarmed, in the first mode."""
    set_mode.enter_first(v)
    v.autopilot.arming.landed = True
    v.autopilot.battery.remaining_pct = -1.0
    pilot.init(v.autopilot)


@unit
def update(fleet: Records[Vehicle], i: int) -> None:
    """One period of vehicle ``i``: reads the estimate, writes demands of steering and throttle."""
    v = fleet[i]
    tick = v.tick
    sense(v)
    read_transmitter(v)
    if tick % _TENTH == 0:
        check_slowly(v)
    if tick % _QUARTER == 0:
        arming.update(v)
    if tick % _THIRD == 0:
        smart_rtl_path.update(v, v.autopilot.modes.number != SMART_RTL)
    if tick % _SECOND == 0:
        follow_home(v)
    run_mode(v)
    motor_test.update(v)


@law
def read_transmitter(v: Vehicle) -> None:
    """50 times a second."""
    pilot.read(v)
    failsafe.update_radio(v)
    switch.read_mode(v)
    switch.read_rudder(v)


@law
def check_slowly(v: Vehicle) -> None:
    """Ten times a second."""
    ap = v.autopilot
    battery.monitor(ap.battery, v.sensors, ap.params.BATT)
    failsafe.update_gcs(v)
    failsafe.update_battery(v)
    failsafe.update_ekf(v)
    crash.update(v)


@law
def is_away(pos: Vec3, home_pos: Vec3) -> bool:
    """Whether the vehicle is so far from home that home moves, both NED [m]."""
    away = horizontal(pos) - horizontal(home_pos)
    return dot2(away, away) >= HOME_MOVES * HOME_MOVES


@law
def follow_home(v: Vehicle) -> None:
    """Once a second: home is set with the first position; disarmed it moves with the vehicle, unless locked."""
    ap = v.autopilot
    if not ap.home.is_set:
        home.set_first(ap.home, ap.estimate)
    elif not (ap.arming.armed or ap.home.locked) and ap.estimate.position_ok:
        if is_away(ap.estimate.pos, ap.home.pos):
            home.set_here(ap.home, ap.estimate)


@law
def run_mode(v: Vehicle) -> None:
    """The mode's own period, then the change that it may have asked for."""
    modes = v.autopilot.modes
    table.run(modes.number, v)
    if modes.wanted != 0:
        wanted = modes.wanted - 1
        modes.wanted = 0
        set_mode.request(v, wanted, modes.wanted_reason)
