# SPDX-License-Identifier: BSD-3-Clause
"""The same script for the gRPC generations (mavsdk 3.x, mavsdk-grpc 4.x): python grpc_mavsdk.py PORT."""

import asyncio
import contextlib
import json
import os
import sys
import time

try:
    from mavsdk_grpc import System
    from mavsdk_grpc.mission_raw import MissionItem
    from mavsdk_grpc.offboard import VelocityNedYaw
except ImportError:
    from mavsdk import System
    from mavsdk.mission_raw import MissionItem
    from mavsdk.offboard import VelocityNedYaw


async def main() -> None:
    measured = {}
    drone = System()
    await drone.connect(system_address=f"tcpout://127.0.0.1:{sys.argv[1]}")
    async for state in drone.core.connection_state():
        if state.is_connected:
            break
    await drone.action.arm()
    items = [
        MissionItem(n, 3, 16, int(n == 0), 1, 0.0, 0.0, 0.0, float("nan"), 473977420, 85455940, 10.0, 0)
        for n in range(5)
    ]
    start = time.monotonic()
    await drone.mission_raw.upload_mission(items)
    measured["upload_s"] = time.monotonic() - start

    await drone.offboard.set_velocity_ned(VelocityNedYaw(1.0, 0.0, 0.0, 0.0))
    await drone.offboard.start()
    await asyncio.sleep(7)
    with contextlib.suppress(Exception):
        await drone.info.get_speed_factor()  # the server begins to measure at the first question
    await asyncio.sleep(3)
    measured["speed_factor"] = await drone.info.get_speed_factor()
    await drone.offboard.stop()

    await asyncio.sleep(5)
    start = time.monotonic()
    try:
        await drone.action.land()  # the vehicle does not answer
        measured["land"] = "answered"
    except Exception as error:
        measured["land"] = str(error)
    measured["land_s"] = time.monotonic() - start

    try:
        await drone.action.terminate()  # the vehicle falls silent here
    except Exception as error:
        measured["terminate"] = str(error)
    start = time.monotonic()
    async for state in drone.core.connection_state():
        if not state.is_connected:
            break
    measured["lost_s"] = time.monotonic() - start
    print(json.dumps(measured), flush=True)
    # Without these two lines such a script hangs at its end, on simulated time or not: MAVSDK's own
    # shutdown does.
    drone._server_process.kill()
    os._exit(0)


asyncio.run(main())
