#!/usr/bin/env bash
# SPDX-License-Identifier: BSD-3-Clause
# pymavlink 2.4.50: Euler angles of a camera that looks exactly straight down, as it does over every survey. Of the quaternion of a
# GIMBAL_DEVICE_ATTITUDE_STATUS with roll 0, pitch -90 and any yaw, QuaternionBase.euler gives yaw 0: what it computes yaw from is 0
# there, by a wrong sign (pitch +90 comes out right). Quaternion.euler of the same module, and so mavextra.quat_to_euler, gives yaw 0 or
# 180, and for about half of the yaws a pitch of 180. At -89.9 both are right. There is no error, but the picture's north is lost.
# The matrix is right, and so are its angles in the order of a gimbal's axes: Quaternion(q).dcm.to_euler312().
# Seen: the lines below. Fails if one of the two finds the yaw of a camera that looks down, or to_euler312 does not.
set -euo pipefail
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
python3 -m venv "$work/venv"
"$work/venv/bin/pip" install -q pymavlink==2.4.50 numpy==2.4.6
MAVLINK20=1 "$work/venv/bin/python" - <<'PYTHON'
import math

import numpy as np
from pymavlink import mavutil
from pymavlink.quaternion import Quaternion, QuaternionBase

sender = mavutil.mavlink.MAVLink(None, srcSystem=1, srcComponent=154)
WAYS = {
    "QuaternionBase(q).euler": lambda q: QuaternionBase(q).euler,
    "Quaternion(q).euler": lambda q: Quaternion(q).euler,
    "Quaternion(q).dcm.to_euler312()": lambda q: Quaternion(q).dcm.to_euler312(),
}


def received(pitch, yaw):
    """The quaternion as a client gets it, of angles [deg]."""
    half = math.radians(pitch) / 2, math.radians(yaw) / 2
    (cp, cy), (sp, sy) = map(math.cos, half), map(math.sin, half)
    q = (cp * cy, -sp * sy, sp * cy, cp * sy)
    message = mavutil.mavlink.MAVLink_gimbal_device_attitude_status_message(0, 0, 0, 0, q, 0, 0, 0, 0)
    return mavutil.mavlink.MAVLink(None).parse_buffer(message.pack(sender))[0].q


def is_off(found, wanted):
    return any(abs((a - b + 180.0) % 360.0 - 180.0) > 0.1 for a, b in zip(found, wanted))


for pitch in (-90.0, -89.9):
    for name, euler in WAYS.items():
        wrong, upside_down = 0, 0
        for yaw in range(-180, 180):
            angles = np.degrees(euler(received(pitch, yaw)))
            wrong += is_off(angles, (0.0, pitch, yaw))
            upside_down += abs(angles[1]) > 90.1
        print(f"pitch {pitch}, {name}: of 360 yaws {wrong} are wrong, {upside_down} with a pitch of 180")
        if pitch == -90.0 and not name.endswith("to_euler312()"):
            assert wrong > 350 and (upside_down > 100) == (name == "Quaternion(q).euler")
        else:
            assert wrong == upside_down == 0
print("yaw 90 is", np.degrees(QuaternionBase(received(-90.0, 90.0)).euler), np.degrees(Quaternion(received(-90.0, 90.0)).euler))
PYTHON
