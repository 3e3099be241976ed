# SPDX-License-Identifier: BSD-3-Clause
"""The camera's parameters (CAM1_*). The core does not read these."""

from __future__ import annotations

NO_CAMERA, BY_SERVO, BY_RELAY, BY_MAVLINK = 0, 1, 4, 5
"""CAM1_TYPE"""
TRIGGER = 10
"""SERVOn_FUNCTION of an output that triggers the camera."""
OUTPUTS = 16

MEANINGS = {
    "CAM1_TYPE": "Camera, from the next boot on: 0 none, 1 triggered by a servo output, 4 by a relay, 5 by MAVLink",
    "CAM1_DURATION": "How long a picture's pulse lasts [s]",
    "CAM1_SERVO_ON": "Pulse that takes a picture [us]",
    "CAM1_SERVO_OFF": "Pulse at other times [us]",
    "CAM1_TRIGG_DIST": "A picture each time that the vehicle is so far from the last one [m]; 0: none",
    "CAM1_RELAY_ON": "1: the relay is on while a picture is taken; 0: it is off",
    "CAM1_INTRVAL_MIN": "Shortest time between two pictures [s]",
}
"""Parameters that are read outside the core, and what they do."""
