# SPDX-License-Identifier: BSD-3-Clause
"""The rover as a kind of vehicle: its record, its core's entries, and where what others need of it is."""

from __future__ import annotations

import math
from collections.abc import Sequence

import numpy as np

from ..autopilot.rover.displaced_targets import move as move_firmware
from ..autopilot.rover.firmware import FIRMWARE, update
from ..autopilot.rover.parameters import Simulated
from ..autopilot.rover.state import Autopilot
from ..core.algebra import euler_of
from ..core.constants import TICK_S
from ..core.displacement import Displacement, speed_along
from ..core.elementary import tan
from ..core.kernels import law, unit
from ..core.mavlink import MavType
from ..core.memory import record_at
from ..core.records import Floats
from ..core.vectors import Vec2
from ..physics.native.displaced_body import show_field
from ..physics.native.rover import pieces
from ..physics.native.rover.drive import commanded
from ..physics.native.rover.init import init
from ..physics.native.rover.motion import hold_back
from ..physics.native.rover.prepare import prepare
from ..physics.native.rover.state import Physics, SteeringServo
from ..physics.native.rover.step import STEERING_OUTPUT, THROTTLE_OUTPUT, step
from ..physics.native.traffic import Mover
from ..vehicles import RoverAirframe
from ..vehicles.properties.ground_vehicle import STEERING_SKID
from . import sim_parameters
from .advance import advance_ticks, fly_tick
from .kind import Kind
from .move import DONE, IN_SOLID, ORDER_SIZE, MoveOrder, displace, look_around
from .record import Vehicle
from .traffic import show, take_push

SIMULATED_ENCODER = 10
"""WENC_TYPE"""
DEFAULT_SERVO_SPEED = float(np.float32(0.14))
"""SIM_SERVO_SPEED that leaves the airframe's steering servo as it is [s for 60 degrees]."""
ENCODER_TICKS = 8
"""They are read 50 times a second, as ArduPilot's."""


class Rover(Vehicle):
    """A rover."""

    physics: Physics
    autopilot: Autopilot


@law
def drive(fleet: Sequence[Rover], index: int) -> None:
    """What follows a tick of physics."""
    fly_tick(fleet, index, update)


@unit
def advance(fleet: Sequence[Rover], index: int, ticks: int) -> None:
    """Up to ``ticks`` ticks of physics and autopilot."""
    advance_ticks(fleet, index, ticks, step, drive)


@unit
def fly(fleet: Sequence[Rover], index: int) -> None:
    """One tick of the autopilot after a tick of any physics."""
    drive(fleet, index)


@law
def move_autopilot(v: Rover, d: Displacement) -> None:
    """Move the firmware, and the wheels, which turn with the vehicle's speed."""
    move_firmware(v.autopilot, d)
    wheels, speed = v.physics.wheels, speed_along(d, euler_of(v.physics.body.q).yaw)
    wheels.forward += speed
    wheels.speed += Vec2(speed, speed)


@law
def obey(v: Rover, order: MoveOrder, ranging: int) -> int:
    """Move one vehicle as ordered; DONE or IN_SOLID."""
    p = v.physics
    before = p.body.q
    d = displace(v, order, move_autopilot)
    if order.other_properties:
        prepare(p.airframe, p.derived)
    show_field(p, v.sensors, before)
    return DONE if look_around(v, ranging, order, d) else IN_SOLID


@unit
def move(fleet: Sequence[Rover], index: int, count: int, orders: int, ranging: int) -> None:
    """Move vehicles as ``count`` orders at an address say; ``index`` says nothing."""
    for k in range(count):
        order = record_at(MoveOrder, orders + k * ORDER_SIZE)
        order.result = obey(fleet[order.vehicle], order, ranging)


@unit
def meet(fleet: Sequence[Rover], index: int, mover: int, shows: int) -> None:
    """Show vehicle ``index`` to those that share its world (``shows`` 1), or take over what came of meeting them (0);
    ``mover``: address of its ``Mover``."""
    v, m = fleet[index], record_at(Mover, mover)
    if shows != 0:
        show(v, m)
    elif m.is_pushed:
        take_push(v, m)
        p = v.physics
        hold_back(p.body, p.obstacles, p.wheels, p.airframe.rear_axle)


def hold_outputs(p: Physics, sim: Simulated, controls: Floats) -> None:
    """Outputs of steering and motors that fail or are stuck, from now on."""
    wheels, fails, stuck = p.wheels, int(sim.ENGINE_FAIL), int(sim.ENGINE_STUCK)
    first, second = STEERING_OUTPUT, THROTTLE_OUTPUT
    left, right = (sim.ENGINE_MUL if fails >> k & 1 else 1.0 for k in (first, second))
    now = [commanded(float(controls[k]), p.derived.control_scale) for k in (first, second)]
    held = zip((first, second), wheels.held, now, strict=True)
    wheels.held = Vec2(*(old if wheels.stuck >> k & 1 else new for k, old, new in held))
    wheels.share, wheels.stuck = Vec2(left, right), stuck
    wheels.is_faulty = bool((fails | stuck) & (1 << first | 1 << second))


def slow_servo(servo: SteeringServo, delay: int, hz: float) -> None:
    """Delay [ticks] and low-pass (Butterworth, by the bilinear transform) of the steering servo's commands."""
    if not servo.is_slow:
        servo.kept, servo.first, servo.second = 0, 0.0, 0.0
    servo.delay, servo.is_filtered = delay, hz > 0.0
    servo.is_slow = delay > 0 or servo.is_filtered
    if servo.is_filtered:
        k = tan(math.pi * hz * TICK_S)
        norm = 1.0 / (1.0 + math.sqrt(2.0) * k + k * k)
        servo.gain = k * k * norm
        servo.a1, servo.a2 = 2.0 * (k * k - 1.0) * norm, (1.0 - math.sqrt(2.0) * k + k * k) * norm


def slow_down(p: Physics, sim: Simulated) -> None:
    """Motors and steering servo as slow as the parameters say."""
    slow_servo(p.wheels.servo, round(sim.SERVO_DELAY / TICK_S), sim.SERVO_FILTER)
    d = p.derived
    rate = 0.0 if sim.SERVO_SPEED == DEFAULT_SERVO_SPEED else math.radians(60.0) / sim.SERVO_SPEED
    if (d.motor_lag, d.servo_rate) != (sim.ENGINE_LAG, rate) and d.control_scale > 0.0:  # before power-on it is 0
        d.motor_lag, d.servo_rate = sim.ENGINE_LAG, rate
        prepare(p.airframe, d)


def apply_sim_parameters(v: Rover) -> None:
    """SIM_ parameters of all kinds, those of the outputs, and the simulated wheel encoders that WENC_TYPE asks for."""
    sim_parameters.apply(v)
    hold_outputs(v.physics, v.autopilot.params.SIM, v.actuators.controls)
    slow_down(v.physics, v.autopilot.params.SIM)
    wheels, p = v.physics.wheels, v.autopilot.params.WENC
    wheels.encoder_period = ENCODER_TICKS if p.TYPE == SIMULATED_ENCODER else 0
    wheels.encoder_step = 2.0 * math.pi * p.RADIUS / p.CPR


def motor_output(v: Rover) -> float:
    """Control of the throttle, -1 .. 1."""
    return float(v.actuators.controls[THROTTLE_OUTPUT])


def idle_parameters(airframe: RoverAirframe) -> tuple[str, ...]:
    """Wind moves no rover, and a skid-steered one has no steering servo."""
    is_skid = airframe.value("steering_model") == STEERING_SKID
    return ("SIM_WIND_", "SIM_SERVO_") if is_skid else ("SIM_WIND_",)


ROVER = Kind(
    firmware=FIRMWARE,
    airframe=RoverAirframe,
    record=Rover,
    advance=advance,
    fly=fly,
    step=step,
    move=move,
    meet=meet,
    pieces=pieces,
    init_physics=init,
    apply_sim_parameters=apply_sim_parameters,
    outputs=lambda airframe: (STEERING_OUTPUT + 1, THROTTLE_OUTPUT + 1),
    idle_parameters=idle_parameters,
    default_frame="erle_rover",
    mav_type=MavType.GROUND_ROVER,
    other_mav_types=(MavType.SURFACE_BOAT,),
    flies=False,
    has_reversible_outputs=True,
    motor_output=motor_output,
    engines={
        "pybullet": "sitl.physics.pybullet.wheeled_rover:BulletRover",
        "jsbsim": "sitl.physics.jsbsim.drivetrain:make",
    },
    demo_script="mavsdk_rover.py",
    programs={"ardupilot": "ardurover", "px4": "px4"},
    ardupilot_models={"rover": "ardupilot_rover", "rover-skid": "skid_rover", "calibration": "calibration_rover"},
    flight_parameters=("WP_", "CRUISE_SPEED", "TURN_", "RTL_", "MIS_", "LOIT_", "CIRC_", "GUID_"),
    parts={
        "mavlink": "sitl.bridge.rover.profile:PROFILE",
        "logs": "sitl.logs.dataflash.rover_messages:LOGS",
        "environments": "sitl.envs.robots.rover:ROBOT",
        "view": "sitl.view.rover_model:VIEW",
    },
)
