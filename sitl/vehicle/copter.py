# SPDX-License-Identifier: BSD-3-Clause
"""The multicopter as a kind of vehicle: its record, its core's entries, and where what others need of it is."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from ..autopilot.copter.displaced_targets import move as move_firmware
from ..autopilot.copter.firmware import FIRMWARE, update
from ..autopilot.copter.state import Autopilot
from ..autopilot.copter.trim import is_flying, total_thrust
from ..autopilot.copter.trim import trim as trim_firmware
from ..autopilot.events import emit
from ..autopilot.hits import HIT_GROUND
from ..autopilot.terrain.ground import height_in_square
from ..core.algebra import rotate
from ..core.border import ACC_SILENT, GYRO_SILENT, IMUS_DIFFER
from ..core.displacement import Displacement
from ..core.kernels import inlined, law, unit
from ..core.mavlink import MavType
from ..core.memory import record_at
from ..core.vectors import Vec2, Vec3
from ..physics.native.copter import pieces
from ..physics.native.copter.init import init
from ..physics.native.copter.prepare import prepare
from ..physics.native.copter.state import ALL_DRIVEN, DRIVEN, Physics
from ..physics.native.copter.step import step
from ..physics.native.copter.trim import balance, command_speeds
from ..physics.native.displaced_body import show_field
from ..physics.native.records import GROUND_AIRBORNE, IMUS
from ..physics.native.traffic import Mover
from ..vehicles import CopterAirframe
from . import sim_parameters
from .advance import advance_ticks, fly_tick
from .kind import Kind
from .move import DONE, IN_SOLID, NO_HOVER, ORDER_SIZE, MoveOrder, displace, is_calm, look_around
from .record import Vehicle
from .traffic import show, take_push

OTHER_MULTIROTORS = (
    MavType.HEXAROTOR,
    MavType.OCTOROTOR,
    MavType.TRICOPTER,
    MavType.DODECAROTOR,
    MavType.DECAROTOR,
)


class Copter(Vehicle):
    """A copter."""

    physics: Physics
    autopilot: Autopilot


@unit
def advance(fleet: Sequence[Copter], index: int, ticks: int) -> None:
    """Up to ``ticks`` ticks of physics and autopilot."""
    advance_ticks(fleet, index, ticks, step, fly_after_touch)


@unit
def fly(fleet: Sequence[Copter], index: int) -> None:
    """One tick of the autopilot after a tick of any physics."""
    fly_after_touch(fleet, index)


@inlined
def fly_after_touch(fleet: Sequence[Copter], index: int) -> None:
    """What follows a tick of physics."""
    v = fleet[index]
    report_touch(v)
    fly_tick(fleet, index, update)
    if v.autopilot.terrain.shapes:
        shape_ground(v)


@law
def shape_ground(v: Copter) -> None:
    """The simulated ground is as high as the terrain's data says, beside where the vehicle was switched on."""
    t, body = v.autopilot.terrain, v.physics.body
    if t.is_known:
        v.physics.downward.ground_d = t.start - height_in_square(t, Vec2(body.pos.x, body.pos.y))


@inlined
def report_touch(vehicle: Copter) -> None:
    """HIT_GROUND when the vehicle came down hard in this tick."""
    ground = vehicle.physics.ground
    if ground.hit_count > 0 and ground.hit_time_us == vehicle.time_us:
        emit(vehicle.autopilot.events, vehicle.time_us, HIT_GROUND, float(ground.hit_speed), 0.0)


@law
def move_autopilot(v: Copter, d: Displacement) -> None:
    """Move the firmware."""
    move_firmware(v.autopilot, d)


@law
def hover_again(v: Copter) -> bool:
    """Let rotors, lean and what the autopilot has learnt of them fit what acts on a vehicle in the air now; False:
    they cannot."""
    p, motors, params = v.physics, v.autopilot.control.motors, v.autopilot.params.MOT
    if p.ground.state != GROUND_AIRBORNE or not is_flying(motors):
        return True
    thrust = total_thrust(motors, v.actuators, params)
    before = p.body.specific_force
    found = balance(p, rotate(p.body.q, before))
    if not (found.holds and thrust > 0.0):
        return False
    command_speeds(p, v.actuators.controls)
    v.sensors.acc += p.body.specific_force - before
    trim_firmware(v.autopilot, v.actuators, found.turn, thrust)
    return True


@law
def obey(v: Copter, order: MoveOrder, ranging: int) -> int:
    """Move one vehicle as ordered; DONE, IN_SOLID or NO_HOVER."""
    p = v.physics
    before, was_calm = p.body.q, is_calm(v)
    d = displace(v, order, move_autopilot)
    if order.other_properties:
        prepare(p.airframe, p.derived)
    if order.other_properties or order.says_velocity or not (was_calm and is_calm(v)):
        if not hover_again(v):
            return NO_HOVER
    show_field(p, v.sensors, before)
    return DONE if look_around(v, ranging, order, d) else IN_SOLID


@unit
def move(fleet: Sequence[Copter], index: int, count: int, orders: int, ranging: int) -> None:
    """Move vehicles as ``count`` orders at an address say; ``index`` says nothing."""
    for k in range(count):
        order = record_at(MoveOrder, orders + k * ORDER_SIZE)
        order.result = obey(fleet[order.vehicle], order, ranging)


@unit
def meet(fleet: Sequence[Copter], index: int, mover: int, shows: int) -> None:
    """Show vehicle ``index`` to those that share its world (``shows`` 1), or take over what came of meeting them (0);
    ``mover``: address of its ``Mover``."""
    v, m = fleet[index], record_at(Mover, mover)
    if shows != 0:
        show(v, m)
    elif m.is_pushed:
        take_push(v, m)


def apply_sim_parameters(v: Copter) -> None:
    """SIM_ parameters of all kinds, those of a copter's motors, and its shove."""
    sim_parameters.apply(v)
    params, rotors, properties = v.autopilot.params, v.physics.rotors, v.physics.airframe
    v.physics.wind.time_constant *= properties.wind_lag
    v.autopilot.control.motors.learns_at_rest = properties.learns_at_rest != 0
    rotors.telemetry = params.SIM.ESC_TELEM != 0
    rotors.rpm_armed, rotors.rpm_max = params.SIM.ESC_ARM_RPM, 60.0 * params.SIM.VIB_MOT_MAX
    _vibrate(v)
    for k in range(len(rotors.share)):
        fails = int(params.SIM.ENGINE_FAIL) >> k & 1
        rotors.share[k] = params.SIM.ENGINE_MUL if fails else 1.0
    rotors.stuck = int(params.SIM.ENGINE_STUCK) | (ALL_DRIVEN if rotors.stuck & DRIVEN else 0)
    sim, shove, derived = params.SIM, v.physics.shove, v.physics.derived
    if derived.motor_lag != sim.ENGINE_LAG and derived.dt > 0.0:  # before power-on it is 0
        derived.motor_lag = sim.ENGINE_LAG
        prepare(v.physics.airframe, derived)
    if sim.SHOVE_TIME > 0.0:
        shove.accel = Vec3(sim.SHOVE_X, sim.SHOVE_Y, sim.SHOVE_Z)
        shove.until_us = v.time_us + round(sim.SHOVE_TIME * 1000.0)
        sim.SHOVE_TIME = 0.0
    if sim.TWIST_TIME > 0.0:
        shove.twist = Vec3(sim.TWIST_X, sim.TWIST_Y, sim.TWIST_Z)
        shove.twist_until_us = v.time_us + round(sim.TWIST_TIME * 1000.0)
        sim.TWIST_TIME = 0.0


def _vibrate(v: Copter) -> None:
    """With SIM_VIB_MOT_MAX the noise of the IMUs that send samples is vibration of the rotors."""
    sim, rotors, sensors = v.autopilot.params.SIM, v.physics.rotors, v.physics.sensors
    rotors.vibrating, rotors.harmonics = int(sim.VIB_MOT_MASK), int(sim.VIB_MOT_HMNC)
    for k in range(IMUS):
        imu = sensors.imus[k]
        rotors.acc_shake[k] = rotors.gyro_shake[k] = 0.0
        if sim.VIB_MOT_MAX == 0.0:
            continue
        if k == 0 or sensors.imu_state & IMUS_DIFFER:
            if not sensors.imu_state & ACC_SILENT << k and imu.acc_stuck == 0.0:
                rotors.acc_shake[k] = sim.VIB_MOT_MULT * imu.acc_noise
            if not sensors.imu_state & GYRO_SILENT << k:
                rotors.gyro_shake[k] = sim.VIB_MOT_MULT * imu.gyro_noise
        imu.acc_noise = imu.gyro_noise = 0.0
    rotors.shakes = any(rotors.acc_shake) or any(rotors.gyro_shake)


def motor_output(v: Copter) -> float:
    """Mean control of the rotors, 0 .. 1."""
    count = int(v.physics.airframe.rotor_count)  # type: ignore[attr-defined]
    return float(np.mean(v.actuators.controls[:count]))


COPTER = Kind(
    firmware=FIRMWARE,
    airframe=CopterAirframe,
    record=Copter,
    advance=advance,
    fly=fly,
    step=step,
    move=move,
    meet=meet,
    pieces=pieces,
    init_physics=init,
    apply_sim_parameters=apply_sim_parameters,
    outputs=lambda airframe: range(1, len(airframe.rotors) + 1),
    default_frame="erle_copter",
    mav_type=MavType.QUADROTOR,
    other_mav_types=OTHER_MULTIROTORS,
    flies=True,
    has_reversible_outputs=False,
    motor_output=motor_output,
    engines={"pybullet": "sitl.physics.pybullet.engine:BulletEngine", "jsbsim": "sitl.physics.jsbsim.rotors:make"},
    demo_script="mavsdk_mission.py",
    programs={"ardupilot": "arducopter", "px4": "px4"},
    # It arms with a gyro sample each 1 / 1.8 of its loop, and gets one a step: 720 at 400 loops a second.
    ardupilot_parameters={"FRAME_CLASS": 1, "SIM_RATE_HZ": 800},
    ardupilot_models={
        "+": "ardupilot_quad", "quad": "ardupilot_quad", "copter": "ardupilot_quad", "x": "ardupilot_x",
        "hexa": "ardupilot_hexa", "hexax": "ardupilot_hexa_x", "octa": "ardupilot_octa",
        "octa-quad": "ardupilot_octa_quad", "y6": "ardupilot_y6", "calibration": "calibration_copter",
    },
    flight_parameters=(
        "WPNAV_", "WP_", "RTL_", "LAND_", "LOIT_", "PILOT_", "TKOFF_", "GUID_", "AUTO_", "MIS_", "CIRCLE_",
    ),
    parts={
        "mavlink": "sitl.bridge.copter.profile:PROFILE",
        "logs": "sitl.logs.dataflash.copter_messages:LOGS",
        "environments": "sitl.envs.robots.copter:ROBOT",
        "view": "sitl.view.copter_model:VIEW",
    },
)  # fmt: skip
