# SPDX-License-Identifier: BSD-3-Clause
"""DroneKit 2.9.2: attitudes and thrust in GUIDED_NOGPS, in the order of its published example."""

import collections
import collections.abc
import math
import sys
import time

collections.MutableMapping = collections.abc.MutableMapping
from dronekit import VehicleMode, connect  # noqa: E402

NO_RATES = 0b111
vehicle = connect(sys.argv[1], wait_ready=True, timeout=60)


def check(what, ok, seen=""):
    print(f"{'ok' if ok else 'FAILED'}: {what} {seen}", flush=True)
    if not ok:
        sys.exit(1)


def send(pitch, yaw, mask, thrust):
    """An attitude [rad] with a thrust from 0 to 1; 0.5 keeps the height."""
    p, y = 0.5 * pitch, 0.5 * yaw
    q = [math.cos(p) * math.cos(y), -math.sin(p) * math.sin(y), math.sin(p) * math.cos(y), math.cos(p) * math.sin(y)]
    vehicle.send_mavlink(vehicle.message_factory.set_attitude_target_encode(0, 1, 1, mask, q, 0, 0, 0, thrust))


def hold(seconds, pitch_deg=0.0, thrust=0.5):
    """Keep an attitude, then level out."""
    end = time.monotonic() + seconds
    while True:
        send(math.radians(pitch_deg), vehicle.attitude.yaw, NO_RATES, thrust)
        if time.monotonic() >= end:
            break
        time.sleep(0.1)
    send(0.0, 0.0, 0, thrust)


def height():
    return vehicle.location.global_relative_frame.alt


def ahead():
    """Speed along the nose [m/s]."""
    yaw = vehicle.attitude.yaw
    return vehicle.velocity[0] * math.cos(yaw) + vehicle.velocity[1] * math.sin(yaw)


while not vehicle.is_armable:
    time.sleep(1)
vehicle.mode = VehicleMode("GUIDED_NOGPS")
vehicle.armed = True
while not vehicle.armed:
    vehicle.armed = True
    time.sleep(1)
end = time.monotonic() + 30
while height() < 0.95 * 2.5 and time.monotonic() < end:
    hold(0.0, thrust=0.6 if height() >= 0.6 * 2.5 else 0.7)
    time.sleep(0.2)
check("at height", height() >= 0.95 * 2.5, height())
hold(3)
check("height is kept", 1.5 < height() < 5.0, height())
hold(3.21, pitch_deg=-5)
fastest = ahead()
check("forward", fastest > 1.0, fastest)
hold(3, pitch_deg=5)
check("and braked", ahead() < fastest - 1.5, ahead())
vehicle.mode = VehicleMode("LAND")
end = time.monotonic() + 30
while vehicle.armed and time.monotonic() < end:
    time.sleep(0.2)
check("landed", not vehicle.armed)
vehicle.close()
