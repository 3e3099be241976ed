# SPDX-License-Identifier: BSD-3-Clause
"""Record of a multicopter's physics: what every vehicle has (``records``), rotors and contact with the ground."""

from __future__ import annotations

from ....core.records import record
from ....vehicles.figures.copter import FIGURES_DTYPE, ROTORS_MAX
from ..records import DERIVED_SHARED, physics_dtype

DERIVED_DTYPE = record(  # follows from the figures (prepare.py)
    ("dt", "f8"),  # substep [s]
    ("inverse_mass", "f8"),
    ("inverse_inertia", "f8", 3),
    ("control_scale", "f8"),  # 1 / (control_max - control_min)
    ("command_step", "f8"),  # largest change of command a tick
    ("decay_up", "f8"),  # what is left of a speed error after a substep
    ("decay_down", "f8"),
    ("speed_per_volt", "f8"),  # speed_max / speed_voltage, 0 without limit
    ("voltage_scale", "f8"),  # 1 / battery_voltage_full
    ("leg_release", "f8"),  # share of an impact that the legs take up in a tick
    *DERIVED_SHARED,
)

ROTORS_DTYPE = record(
    ("command", "f8", ROTORS_MAX),  # 0 .. 1
    ("speed", "f8", ROTORS_MAX),  # [rad/s]; THRUST_MOMENTUM: the lagged command 0 .. 1
    ("thrust", "f8", ROTORS_MAX),  # [N]
    ("efficiency", "f8", ROTORS_MAX),  # share of the thrust left, 1 healthy: a motor fault
    ("power", "f8"),  # taken from the battery by all [W]
)

GROUND_AIRBORNE = 0
GROUND_STANDING = 1
GROUND_LYING = 2
"""Tipped over: it stays as it fell, whatever the rotors do."""

GROUND_DTYPE = record(
    ("state", "i8"),  # GROUND_*
    ("hit_count", "i8"),  # touches so far that were faster than the airframe's hit_speed
    ("hit_speed", "f4"),  # of the last one, vertical [m/s]
    ("hit_time_us", "i8"),
    ("impulse", "f8"),  # vertical impact that the legs still have to take up [m/s]
)

PHYSICS_DTYPE = physics_dtype(FIGURES_DTYPE, DERIVED_DTYPE, ("ground", GROUND_DTYPE), ("rotors", ROTORS_DTYPE))
