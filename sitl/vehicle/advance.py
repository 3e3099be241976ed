# SPDX-License-Identifier: BSD-3-Clause
"""The core's entries for each kind of vehicle: physics and autopilot, tick by tick, until something needs Python.

``advance(fleet, index, ticks)`` advances one vehicle by up to ``ticks`` ticks of 2500 us. It returns early, at the end
of a tick in which something happened (``autopilot.events``), or in which the vehicle came to the end of its list of
solids. The border is crossed once a tick: physics writes ``sensors``, the autopilot reads them and writes
``actuators``. ``fly(fleet, index)`` is the autopilot's part of one tick alone, behind other physics.
"""

from __future__ import annotations

from ..autopilot.copter import firmware as copter
from ..autopilot.events import HIT_GROUND, HIT_OBSTACLE, emit
from ..autopilot.inertial_ring import remember
from ..autopilot.rover import firmware as rover
from ..core.kernels import law, unit
from ..physics.native.copter.step import step as step_copter
from ..physics.native.rover.step import step as step_rover
from .truth_estimator import observe


@unit
def advance_copter(fleet, index, ticks):
    """Up to ``ticks`` ticks of a copter."""
    events = fleet[index].autopilot.events
    told = events.count
    for _ in range(ticks):
        step_copter(fleet, index)
        react_copter(fleet, index)
        if events.attention != 0 or events.count != told:
            break


@unit
def advance_rover(fleet, index, ticks):
    """Up to ``ticks`` ticks of a rover."""
    events = fleet[index].autopilot.events
    told = events.count
    for _ in range(ticks):
        step_rover(fleet, index)
        react_rover(fleet, index)
        if events.attention != 0 or events.count != told:
            break


@unit
def fly_copter(fleet, index):
    """One tick of a copter's autopilot after a tick of any physics."""
    react_copter(fleet, index)


@unit
def fly_rover(fleet, index):
    """One tick of a rover's autopilot after a tick of any physics."""
    react_rover(fleet, index)


@law
def react_copter(fleet, index):
    """What follows a tick of physics: what it reports, then the autopilot, from sensors to actuators."""
    vehicle = fleet[index]
    report_touch(vehicle)
    watch_obstacles(vehicle)
    if vehicle.autopilot.ekf.use_external != 0:
        observe(vehicle)
    copter.update(fleet, index)
    keep_sample(vehicle)


@law
def react_rover(fleet, index):
    """The same for a rover."""
    vehicle = fleet[index]
    watch_obstacles(vehicle)
    if vehicle.autopilot.ekf.use_external != 0:
        observe(vehicle)
    rover.update(fleet, index)
    keep_sample(vehicle)


@law
def keep_sample(vehicle):
    """Last thing of a tick: a sample for on-board logs when it is time."""
    ap, sensors = vehicle.autopilot, vehicle.sensors
    remember(ap.inertial, vehicle.time_us, sensors.acc, sensors.gyro, ap.estimate.euler)


@law
def report_touch(vehicle):
    """HIT_GROUND when the vehicle came down hard in this tick."""
    ground = vehicle.physics.ground
    if ground.hit_count > 0 and ground.hit_time_us == vehicle.time_us:
        emit(vehicle.autopilot.events, vehicle.time_us, HIT_GROUND, float(ground.hit_speed), 0.0)


@law
def watch_obstacles(vehicle):
    """HIT_OBSTACLE when the vehicle ran into a solid in this tick; back to the shell for a new list of solids."""
    obstacles = vehicle.physics.obstacles
    if obstacles.hit_count > 0 and obstacles.hit_time_us == vehicle.time_us:
        emit(vehicle.autopilot.events, vehicle.time_us, HIT_OBSTACLE, float(obstacles.hit_speed), 0.0)
    if obstacles.wanted != 0:
        vehicle.autopilot.events.attention = 1
