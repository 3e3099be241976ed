# SPDX-License-Identifier: BSD-3-Clause
"""The border between autopilot and physics as MAVLink: PX4's simulator API (https://docs.px4.io/main/en/simulation/).

Physics listens, the autopilot connects. A tick of physics is one HIL_SENSOR, with what else is new before it in the
same breath: HIL_GPS, BATTERY_STATUS, WHEEL_DISTANCE, lidar and range-finder, hard touches, truth. The autopilot
answers with HIL_ACTUATOR_CONTROLS that carries the time of the HIL_SENSOR it answers, and physics goes one tick
further for each answer whose time is its own: an older one is a repetition and gets the same tick again.

Each module here is one kind of message in both directions: from a vehicle's record to a payload, and from a payload,
checked, into a record. ``physics_end`` and ``autopilot_end`` are the two ends, bytes in and bytes out, without sockets
or clocks.
"""
