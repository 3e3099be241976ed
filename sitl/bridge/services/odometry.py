# SPDX-License-Identifier: BSD-3-Clause
"""Positions and velocities that another system reports (VISO_TYPE 1), for the estimator's sources 6.

Positions are NED from where the estimate began. Times in the messages are not used: what is reported is VISO_DELAY_MS
old.
"""

from __future__ import annotations

from ...autopilot.visual_odometry import UNKNOWN_QUALITY, take_pose, take_velocity, takes
from ...core.algebra import quat_from_euler
from ...core.kernels import law
from ...core.mavlink import MavFrame
from ...core.records import Floats
from ...core.scalars import finite
from ...core.vectors import Euler, Vec3
from ...vehicle.record import Vehicle
from ..wire.message import Message, consecutive
from .follow_target import vector
from .setpoint_messages import rotation


class VisionPosition(Message, name="VISION_POSITION_ESTIMATE"):
    pos: Vec3 = consecutive("x", "y", "z")
    euler: Euler = consecutive("roll", "pitch", "yaw")
    covariance: Floats
    reset_counter: int


class GlobalVisionPosition(VisionPosition, name="GLOBAL_VISION_POSITION_ESTIMATE"):
    pass


class ViconPosition(Message, name="VICON_POSITION_ESTIMATE"):
    pos: Vec3 = consecutive("x", "y", "z")
    euler: Euler = consecutive("roll", "pitch", "yaw")
    covariance: Floats


class MotionCapture(Message, name="ATT_POS_MOCAP"):
    q: Floats
    pos: Vec3 = consecutive("x", "y", "z")
    covariance: Floats


class VisionSpeed(Message, name="VISION_SPEED_ESTIMATE"):
    vel: Vec3 = consecutive("x", "y", "z")
    covariance: Floats


class VisionDelta(Message, name="VISION_POSITION_DELTA"):
    time_delta_usec: int
    position_delta: Floats
    confidence: float


class Odometry(Message, name="ODOMETRY"):
    frame_id: int
    child_frame_id: int
    pos: Vec3 = consecutive("x", "y", "z")
    q: Floats
    vel: Vec3 = consecutive("vx", "vy", "vz")
    pose_covariance: Floats
    velocity_covariance: Floats
    reset_counter: int
    quality: int


@law
def variance_of(covariance: Floats) -> float:
    """Sum of the variances of x, y and z in the upper triangle of a covariance of six."""
    return float(covariance[0]) + float(covariance[6]) + float(covariance[11])


@law
def pose(v: Vehicle, pos: Vec3, euler: Euler, variance: float, resets: int) -> None:
    """A position with Euler angles."""
    seen, p = v.autopilot.odometry, v.autopilot.params.VISO
    if takes(seen, UNKNOWN_QUALITY, p) and finite(euler.roll + euler.pitch + euler.yaw):
        seen.resets = resets
        take_pose(seen, pos, quat_from_euler(euler), variance, v.time_us, p)


@law
def vision_position(m: VisionPosition, v: Vehicle, sender: int) -> None:
    """VISION_POSITION_ESTIMATE"""
    pose(v, m.pos, m.euler, variance_of(m.covariance), m.reset_counter)


@law
def global_vision_position(m: GlobalVisionPosition, v: Vehicle, sender: int) -> None:
    """GLOBAL_VISION_POSITION_ESTIMATE"""
    pose(v, m.pos, m.euler, variance_of(m.covariance), m.reset_counter)


@law
def vicon_position(m: ViconPosition, v: Vehicle, sender: int) -> None:
    """VICON_POSITION_ESTIMATE"""
    pose(v, m.pos, m.euler, variance_of(m.covariance), 0)


@law
def motion_capture(m: MotionCapture, v: Vehicle, sender: int) -> None:
    """ATT_POS_MOCAP"""
    seen, p, attitude = v.autopilot.odometry, v.autopilot.params.VISO, rotation(m.q)
    if attitude.is_given and takes(seen, UNKNOWN_QUALITY, p):
        take_pose(seen, m.pos, attitude.q, variance_of(m.covariance), v.time_us, p)


@law
def vision_speed(m: VisionSpeed, v: Vehicle, sender: int) -> None:
    """VISION_SPEED_ESTIMATE: NED [m/s]"""
    seen, p = v.autopilot.odometry, v.autopilot.params.VISO
    if takes(seen, UNKNOWN_QUALITY, p):
        variance = float(m.covariance[0]) + float(m.covariance[4]) + float(m.covariance[8])
        take_velocity(seen, m.vel, False, variance, v.time_us, p)


@law
def vision_delta(m: VisionDelta, v: Vehicle, sender: int) -> None:
    """VISION_POSITION_DELTA: the displacement on the body since the last one [m]; its confidence is the quality."""
    seen, p, span = v.autopilot.odometry, v.autopilot.params.VISO, 1e-6 * m.time_delta_usec
    if span > 0.0 and finite(m.confidence) and takes(seen, int(min(max(m.confidence, 0.0), 100.0)), p):
        take_velocity(seen, (1.0 / span) * vector(m.position_delta), True, 0.0, v.time_us, p)


@law
def odometry(m: Odometry, v: Vehicle, sender: int) -> None:
    """ODOMETRY: frame_id LOCAL_FRD (20) or LOCAL_NED (1), child_frame_id BODY_FRD (12); others are left out."""
    seen, p, attitude = v.autopilot.odometry, v.autopilot.params.VISO, rotation(m.q)
    if (m.frame_id != MavFrame.LOCAL_FRD and m.frame_id != MavFrame.LOCAL_NED) or m.child_frame_id != MavFrame.BODY_FRD:
        return
    if attitude.is_given and takes(seen, m.quality, p):
        seen.resets = m.reset_counter
        take_pose(seen, m.pos, attitude.q, variance_of(m.pose_covariance), v.time_us, p)
        take_velocity(seen, m.vel, True, variance_of(m.velocity_covariance), v.time_us, p)


TAKERS = (
    vision_position, global_vision_position, vicon_position, motion_capture, vision_speed, vision_delta, odometry,
)  # fmt: skip
