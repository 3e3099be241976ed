# SPDX-License-Identifier: BSD-3-Clause
"""Rotors: actuator controls to commands, speeds, forces and torques.

Two thrust models behind one interface: RotorS (Furrer et al., "RotorS - A modular Gazebo MAV simulator
framework", 2016: thrust and torque with the square of a lagged speed, rotor drag and rolling moment from the
in-plane air speed) and the momentum model of ArduPilot's SITL multicopter (thrust from outflow and inflow
speed, momentum drag along all axes: in its recordings a climb of 2.5 m/s takes 10 % more thrust than a
hover).
"""

from __future__ import annotations

import math

from ....core.kernels import law
from ....vehicles.figures.copter import THRUST_MOMENTUM


@law
def command(p, controls):
    """Take over the actuator controls [0 .. 1] as rotor commands; called once a tick."""
    a = p.airframe
    lowest = float(a.control_min)
    scale = float(p.derived.control_scale)
    step = float(p.derived.command_step)
    commands = p.rotors.command
    for k in range(int(a.rotor_count)):
        c = (float(controls[k]) - lowest) * scale
        if not c > 0.0:  # also for NaN
            c = 0.0
        elif c > 1.0:
            c = 1.0
        if step > 0.0:
            before = float(commands[k])
            c = min(max(c, before - step), before + step)
        commands[k] = c


@law
def lag(p):
    """Let the rotor speeds follow the commands for a substep; returns the yaw torque [N m] of spinning up."""
    a = p.airframe
    top = 1.0
    if int(a.thrust_model) != THRUST_MOMENTUM:
        top = float(a.speed_max)
    limit = top
    if p.derived.speed_per_volt > 0.0:
        limit = min(top, float(p.derived.speed_per_volt) * float(p.battery.voltage))
    up, down = float(p.derived.decay_up), float(p.derived.decay_down)
    speeds, commands, direction = p.rotors.speed, p.rotors.command, a.rotor_direction
    spin_up = 0.0
    for k in range(int(a.rotor_count)):
        target = min(float(commands[k]) * top, limit)
        before = float(speeds[k])
        error = before - target
        after = target + error * (up if error < 0.0 else down)
        speeds[k] = after
        spin_up += float(direction[k]) * (after - before)
    return spin_up * float(a.rotor_inertia) / float(p.derived.dt)


@law
def speed_squared_wrench(p, vx, vy, roll_rate, pitch_rate, yaw_rate):
    """(fx, fy, fz, mx, my, mz) [N, N m], RotorS model; (vx, vy) air velocity [m/s]; body frame."""
    a = p.airframe
    speeds, thrusts, health = p.rotors.speed, p.rotors.thrust, p.rotors.efficiency
    xs, ys, zs, direction = a.rotor_x, a.rotor_y, a.rotor_z, a.rotor_direction
    k_thrust, k_moment = float(a.thrust_coefficient), float(a.moment_coefficient)
    k_drag, k_roll = float(a.rotor_drag), float(a.rolling_moment)
    fx, fy, fz, mx, my, mz = 0.0, 0.0, 0.0, 0.0, 0.0, 0.0
    momentum, shaft = 0.0, 0.0
    for k in range(int(a.rotor_count)):
        w = float(speeds[k])
        x, y, z = float(xs[k]), float(ys[k]), float(zs[k])
        d = float(direction[k])
        thrust = k_thrust * w * w * float(health[k])
        thrusts[k] = thrust
        hub_x = vx + pitch_rate * z - yaw_rate * y
        hub_y = vy + yaw_rate * x - roll_rate * z
        drag_x = -k_drag * w * hub_x
        drag_y = -k_drag * w * hub_y
        fx += drag_x
        fy += drag_y
        fz -= thrust
        mx += -y * thrust - z * drag_y - k_roll * w * hub_x
        my += x * thrust + z * drag_x - k_roll * w * hub_y
        mz += d * k_moment * thrust + x * drag_y - y * drag_x
        momentum += d * w
        shaft += k_moment * thrust * w
    # Gyroscopic torque: a counter-clockwise rotor's momentum points up, so that the sum is (0, 0, -h).
    h = momentum * float(a.rotor_inertia)
    p.rotors.power = shaft / float(a.efficiency)
    return (fx, fy, fz, mx + pitch_rate * h, my - roll_rate * h, mz)


@law
def momentum_wrench(p, vx, vy, vz, roll_rate, pitch_rate, yaw_rate):
    """(fx, fy, fz, mx, my, mz) [N, N m], momentum model; (vx, vy, vz) air velocity [m/s]; body frame."""
    a = p.airframe
    speeds, thrusts, health = p.rotors.speed, p.rotors.thrust, p.rotors.efficiency
    xs, ys, zs, direction = a.rotor_x, a.rotor_y, a.rotor_z, a.rotor_direction
    expo, lever = float(a.thrust_expo), float(a.yaw_lever)
    half_flow = 0.5 * float(p.air.density) * float(a.outflow_area)
    fastest = float(a.outflow_speed_max) * float(p.battery.voltage) * float(p.derived.voltage_scale)
    fastest2 = fastest * fastest
    k_drag = float(a.momentum_drag) * float(p.air.density_root) * math.sqrt(float(a.disc_area))
    fx, fy, fz, mx, my, mz = 0.0, 0.0, 0.0, 0.0, 0.0, 0.0
    total = 0.0
    for k in range(int(a.rotor_count)):
        c = float(speeds[k])
        x, y, z = float(xs[k]), float(ys[k]), float(zs[k])
        hub_z = vz + roll_rate * y - pitch_rate * x
        inflow = max(-hub_z, 0.0)
        thrust = half_flow * (fastest2 * c * (1.0 - expo + expo * c) - inflow * inflow) * float(health[k])
        thrusts[k] = thrust
        drag = k_drag * math.sqrt(abs(thrust))
        drag_x = -drag * (vx + pitch_rate * z - yaw_rate * y)
        drag_y = -drag * (vy + yaw_rate * x - roll_rate * z)
        axial = thrust + drag * hub_z
        fx += drag_x
        fy += drag_y
        fz -= axial
        mx += -y * axial - z * drag_y
        my += x * axial + z * drag_x
        mz += float(direction[k]) * lever * thrust * c + x * drag_y - y * drag_x
        total += abs(thrust)
    p.rotors.power = total * float(a.power_by_thrust)
    return (fx, fy, fz, mx, my, mz)
