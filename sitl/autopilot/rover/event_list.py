# SPDX-License-Identifier: BSD-3-Clause
"""The rover's events, in the order of their codes: to add one is its declaration and its name here."""

from __future__ import annotations

from .. import arming_checks, aux_switch, failsafe_checks, followed_vehicle, hits, modes, rally, smart_rtl_path
from ..avoidance import bendy_ruler
from ..estimation import estimator_events as ekf
from ..events import with_registered
from ..fence import checks as fence
from ..fence import items as fence_items
from ..landing_target import state as landing_target
from ..navigation import planner
from ..navigation import state as navigation
from . import arming, crash, failsafe, motor_test
from .modes import circle, dock, guided, guided_setpoints, rtl, set_mode

EVENTS = with_registered("rover", (
    arming.ARMED, arming.DISARMED, modes.MODE_CHANGED, navigation.COMMAND_COMPLETE, navigation.LEG_ENDING,
    guided.GUIDED_TIMEOUT, ekf.EKF_INITIALISED, ekf.EKF_TILT_ALIGNED, ekf.EKF_YAW_ALIGNED, ekf.EKF_ORIGIN_SET,
    ekf.EKF_USES_GPS, ekf.EKF_STOPPED_GPS, ekf.EKF_YAW_ALIGNED_IN_FLIGHT, failsafe.FAILSAFE, set_mode.MODE_REFUSED,
    arming_checks.ARMING_REFUSED, motor_test.MOTOR_TEST, rtl.DESTINATION_REACHED, guided.GUIDED_REACHED,
    crash.CRASH_HOLD, smart_rtl_path.PATH_LOST, circle.CIRCLE_ADAPTED, navigation.COMMAND_ARRIVED, hits.HIT_OBSTACLE,
    guided_setpoints.SETPOINT_IGNORED, aux_switch.AUX_SWITCH, smart_rtl_path.PATH_LOW, followed_vehicle.FOLLOW_OFFSET,
    followed_vehicle.FOLLOW_OFF, fence.FENCE_BREACHED, fence.FENCE_CLEAR, fence.FENCE_SWITCHED, fence.FENCE_NEAR,
    fence.FENCE_RECOVERY, planner.NO_PATH, landing_target.LANDING_TARGET_DID, dock.DOCK_DID, ekf.EKF_RELATIVE,
    ekf.EKF_STOPPED_AIDING, ekf.EKF_USES, ekf.EKF_LANE_SWITCHED, ekf.EKF_COMPASS_CHANGED,
    bendy_ruler.BENDY_RULER_LOOKED, fence_items.FENCE_LOADED, rally.RALLY_LOADED, planner.PATH_PLANNED,
    ekf.EKF_EMERGENCY_YAW, failsafe_checks.EVENT_BATTERY_LOW, failsafe_checks.EVENT_BATTERY_CRITICAL,
    failsafe_checks.EVENT_BATTERY_MISSING,
))  # fmt: skip
