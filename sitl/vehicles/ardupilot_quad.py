# SPDX-License-Identifier: BSD-3-Clause
"""ArduPilot's default SITL multicopter ("quad", plus frame), so that flights can be held against recordings of it, and
what its others share with it.

Facts of its model, read from its documentation and measured on an unmodified simulator (4.7-dev, July 2025).
"""

from __future__ import annotations

import math

from ..core.constants import GRAVITY
from ..core.elementary import cos, sin, tan
from . import sensor_sets
from .copter_airframe import CCW, CW, CopterAirframe, Rotor
from .properties.multicopter import THRUST_MOMENTUM

MASS = 3.0  # [kg]
ARM = 0.35  # [m] rotors from the centre
HOVER_POWER = 29.3 * 12.09  # [W] reference current and voltage in the hover
HOVER_THRUST = 0.39  # [1] share of the greatest thrust that hovers
DISC_AREA = 0.385  # [m^2] all rotors
REFERENCE_DENSITY = 1.15682  # [kg/m^3] standard atmosphere at the reference altitude of 593 m
REFERENCE_SPEED = 15.08  # [m/s] reached with ...
REFERENCE_LEAN = math.radians(45.0)  # ... this lean
MOMENTUM_DRAG = 0.2  # [1] drag coefficient of the flow through a rotor
THRUST_EXPO = 0.65  # [1]

WEIGHT = MASS * GRAVITY
OUTFLOW_HOVER = 2.0 * HOVER_POWER / WEIGHT
"""[m/s] Power of a hover: thrust times half the outflow speed."""
OUTFLOW_AREA = WEIGHT / (0.5 * REFERENCE_DENSITY * OUTFLOW_HOVER * OUTFLOW_HOVER)
"""[m^2] Effective area of all rotors: 0.5 rho A v^2 carries the weight."""
OUTFLOW_MAX = OUTFLOW_HOVER / math.sqrt(HOVER_THRUST)


def drag_area() -> float:
    """Drag coefficient times area [m^2]: what momentum drag leaves of the drag at the reference speed."""
    total = WEIGHT * tan(REFERENCE_LEAN)
    lean = cos(REFERENCE_LEAN)
    thrust = WEIGHT / lean
    flow = math.sqrt(thrust * REFERENCE_DENSITY * DISC_AREA)
    momentum = lean * MOMENTUM_DRAG * lean * REFERENCE_SPEED * flow
    return (total - momentum) / (0.5 * REFERENCE_DENSITY * REFERENCE_SPEED * REFERENCE_SPEED)


def multicopter(
    name: str, description: str, rotors: tuple[tuple[float, float], ...], frame_class: int, frame_type: int
) -> CopterAirframe:
    """A multicopter of the same mass, inertia, drag and power.

    Args:
        name: of the airframe.
        description: one line.
        rotors: (angle clockwise from the front [deg], CCW or CW) in the order of the outputs.
        frame_class, frame_type: FRAME_CLASS and FRAME_TYPE.
    """
    count = float(len(rotors))
    return CopterAirframe(
        name=name,
        description=f"ArduPilot's {description}, 3.0 kg",
        rotors=tuple(_rotor(angle, direction) for angle, direction in rotors),
        properties={
            "mass": MASS,
            "inertia": (  # [kg m^2] discs of half the arm
                0.25 * MASS * (0.5 * ARM) * (0.5 * ARM),
                0.25 * MASS * (0.5 * ARM) * (0.5 * ARM),
                0.5 * MASS * (0.5 * ARM) * (0.5 * ARM),
            ),
            "drag_area": (drag_area(), drag_area(), drag_area()),  # [m^2]
            "angular_damping": math.radians(400.0) / 120.0,  # [1/s] 0.058; the recorded yaw turns agree
            "gyroscopic": 0,  # its bodies have moments of inertia, and no angular momentum
            "wind_lag": 1.0 / math.tau,  # it low-passes the wind at 1 / SIM_WIND_TC [Hz]
            "learns_at_rest": 1,
            "thrust_model": THRUST_MOMENTUM,
            "control_min": 0.15,  # spin range of 1000 .. 2000 us
            "control_max": 0.95,
            "command_slew": 150.0,  # [1/s]
            "outflow_area": OUTFLOW_AREA / count,
            "outflow_speed_max": OUTFLOW_MAX,
            "thrust_expo": THRUST_EXPO,
            "yaw_lever": 0.05 * ARM,  # [m]
            "momentum_drag": MOMENTUM_DRAG,
            "disc_area": DISC_AREA / count,
            "power_by_thrust": HOVER_POWER / WEIGHT,  # [W/N]
            "battery_voltage_full": 12.6,  # [V] SIM_BATT_VOLTAGE
            "battery_capacity": 0.0,  # [Ah] SIM_BATT_CAP_AH 0: the voltage stays, as in the recordings
            "battery_resistance": 0.01,  # [ohm] counts once a capacity is given
            "ground_friction": 1.0,  # ArduPilot's stands still on the ground
            "leg_time_constant": 0.02,  # [s] (assumed)
            "tip_angle": math.radians(60.0),  # (assumed)
            "hit_speed": 0.1,  # [m/s]
            "contact_radius": ARM + 0.13,  # [m] rotors of 10 inches (assumed)
            "contact_top": 0.1,  # [m] (assumed)
            **sensor_sets.SITL_IMU,
            **sensor_sets.SITL_GPS,
            **sensor_sets.SITL_BARO,
            **sensor_sets.SITL_MAG,
        },
        parameters={  # ArduPilot's copter defaults for SITL, where they differ from the firmware's
            "FRAME_CLASS": frame_class,
            "FRAME_TYPE": frame_type,
            "ATC_RAT_YAW_P": 0.3,
            "ATC_RAT_YAW_I": 0.02,
            "BATT_MONITOR": 4,  # voltage and current
            "BATT_CAPACITY": 3300,  # [mAh]
            "MOT_BAT_VOLT_MAX": 12.8,  # [V]
            "MOT_BAT_VOLT_MIN": 9.6,  # [V]
            "MOT_THST_HOVER": 0.39,
            "GPS1_DELAY_MS": 100,  # as gps_delay
            "SIM_WIND_T": 0,
        },
    )


def _rotor(angle: float, direction: float) -> Rotor:
    forward, right = cos(math.radians(angle)), sin(math.radians(angle))
    return Rotor(round(ARM * forward, 12) + 0.0, round(ARM * right, 12) + 0.0, 0.0, direction)


AIRFRAME = multicopter(
    "ardupilot_quad", "default SITL quad, plus frame", ((90, CCW), (-90, CCW), (0, CW), (180, CW)), 1, 0
)
