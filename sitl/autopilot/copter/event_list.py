# SPDX-License-Identifier: BSD-3-Clause
"""The copter's events, in the order of their codes: to add one is its declaration and its name here."""

from __future__ import annotations

from .. import arming_checks, aux_switch, failsafe_checks, followed_vehicle, hits, modes, rally, smart_rtl_path
from ..avoidance import bendy_ruler
from ..estimation import estimator_events as ekf
from ..events import with_registered
from ..fence import checks as fence
from ..fence import items as fence_items
from ..landing_target import state as landing_target
from ..mission import returning
from ..navigation import planner
from ..navigation import state as navigation
from ..terrain import ground as terrain
from ..terrain import state as terrain_state
from . import arming, crash, failsafe, failsafe_actions, landing, motor_test, takeoff_check, thrust_loss, yaw_imbalance
from .modes import auto, autotune, ground, guided, payload_place, set_mode, simple, systemid, takeoff, throw, zigzag

EVENTS = with_registered("copter", (
    arming.ARMED, ground.DISARMED, modes.MODE_CHANGED, landing.LANDED, takeoff.TAKEOFF_COMPLETE,
    navigation.COMMAND_COMPLETE, navigation.LEG_ENDING, crash.CRASH_DISARM, guided.GUIDED_TIMEOUT,
    ekf.EKF_INITIALISED, ekf.EKF_TILT_ALIGNED, ekf.EKF_YAW_ALIGNED, ekf.EKF_ORIGIN_SET, ekf.EKF_USES_GPS,
    ekf.EKF_STOPPED_GPS, ekf.EKF_YAW_ALIGNED_IN_FLIGHT, hits.HIT_GROUND, failsafe.FAILSAFE, set_mode.MODE_REFUSED,
    arming_checks.ARMING_REFUSED, motor_test.MOTOR_TEST, smart_rtl_path.PATH_LOST, navigation.COMMAND_ARRIVED,
    hits.HIT_OBSTACLE, aux_switch.AUX_SWITCH, simple.SIMPLE_CHANGED, throw.THROW_STAGE, zigzag.ZIGZAG_DID,
    smart_rtl_path.PATH_LOW, failsafe_actions.NO_RETURN_PATH, thrust_loss.THRUST_LOST, takeoff_check.TAKEOFF_BLOCKED,
    followed_vehicle.FOLLOW_OFFSET, followed_vehicle.FOLLOW_OFF, fence.FENCE_BREACHED, fence.FENCE_CLEAR,
    fence.FENCE_SWITCHED, fence.FENCE_NEAR, fence.FENCE_RECOVERY, returning.RETURN_WANTED, returning.RETURN_ACTIVE,
    systemid.SYSTEM_ID_DID, systemid.SYSTEM_ID_SAMPLE, auto.CIRCLE_BEGINS, planner.NO_PATH,
    landing_target.LANDING_TARGET_DID, autotune.AUTOTUNE_DID, yaw_imbalance.YAW_IMBALANCE, ekf.EKF_RELATIVE,
    ekf.EKF_STOPPED_AIDING, ekf.EKF_USES, ekf.EKF_LANE_SWITCHED, ekf.EKF_COMPASS_CHANGED,
    terrain_state.TERRAIN_DID, terrain.TERRAIN_LEFT,
    bendy_ruler.BENDY_RULER_LOOKED, fence_items.FENCE_LOADED, rally.RALLY_LOADED, planner.PATH_PLANNED,
    ekf.EKF_EMERGENCY_YAW, payload_place.PAYLOAD_PLACE_DID, failsafe_checks.EVENT_BATTERY_LOW,
    failsafe_checks.EVENT_BATTERY_CRITICAL, failsafe_checks.EVENT_BATTERY_MISSING,
))  # fmt: skip
