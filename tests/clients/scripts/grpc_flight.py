# SPDX-License-Identifier: BSD-3-Clause
"""The gRPC generations of MAVSDK (``mavsdk<4`` and ``mavsdk-grpc``): take-off, off-board, mission, RTL, land."""

import asyncio
import math
import sys
from contextlib import aclosing

try:
    import mavsdk_grpc as mavsdk
    from mavsdk_grpc.mission_raw import MissionItem
    from mavsdk_grpc.offboard import OffboardError, VelocityNedYaw
except ImportError:
    import mavsdk
    from mavsdk.mission_raw import MissionItem
    from mavsdk.offboard import OffboardError, VelocityNedYaw

from tests.ports import free_port


class Failed(Exception):
    """What did not happen."""


async def until(what, stream, condition, seconds=30.0):
    try:
        async with asyncio.timeout(seconds), aclosing(stream):
            async for value in stream:
                if condition(value):
                    print("ok:", what, flush=True)
                    return value
    except TimeoutError:
        raise Failed(what) from None


async def main() -> None:
    drone = mavsdk.System(port=free_port())
    await drone.connect(system_address=sys.argv[1])
    action, telemetry, offboard, mission = drone.action, drone.telemetry, drone.offboard, drone.mission_raw
    await until("connected", drone.core.connection_state(), lambda s: s.is_connected)
    await telemetry.set_rate_position(5.0)
    await telemetry.set_rate_velocity_ned(5.0)
    await telemetry.set_rate_home(1.0)
    await telemetry.set_rate_rc_status(2.0)  # SYS_STATUS, which health is made of
    # health of these generations knows nothing of ArduPilot's estimator: wait for what the estimator says
    await until("position", telemetry.status_text(), lambda s: s.text.endswith("is using GPS"), 90.0)
    await until("ready to arm", telemetry.health(), lambda h: h.is_armable and h.is_home_position_ok)
    assert len((await drone.param.get_all_params()).int_params) > 50

    await action.set_takeoff_altitude(10.0)
    await action.arm()
    await action.takeoff()
    start = await until("at height", telemetry.position(), lambda p: p.relative_altitude_m > 9.7)
    try:
        await offboard.start()
        raise Failed("off-board without a set-point must be refused")
    except OffboardError as error:
        print("ok: refused,", error)
    await offboard.set_velocity_ned(VelocityNedYaw(2.0, 0.0, 0.0, 0.0))
    await offboard.start()
    await asyncio.sleep(6.0)
    await until("velocity", telemetry.velocity_ned(), lambda v: abs(v.north_m_s - 2.0) < 0.2, 5.0)
    await offboard.stop()

    place = (round(start.latitude_deg * 1e7), round(start.longitude_deg * 1e7))
    items = [
        MissionItem(0, 3, 16, 1, 1, 0, 0, 0, 0, *place, 0.0, 0),
        MissionItem(1, 3, 22, 0, 1, 0, 0, 0, 0, 0, 0, 10.0, 0),
        MissionItem(2, 3, 16, 0, 1, 0, 0, 0, 0, place[0] + 2500, place[1], 10.0, 0),
        MissionItem(3, 3, 16, 0, 1, 0, 0, 0, 0, *place, 10.0, 0),
    ]
    await mission.upload_mission(items)
    assert len(await mission.download_mission()) == len(items)
    await mission.start_mission()
    await until("on the way to item 3", mission.mission_progress(), lambda m: m.current == 3, 40.0)
    await mission.pause_mission()
    await until("pause", telemetry.velocity_ned(), lambda v: math.hypot(v.north_m_s, v.east_m_s) < 0.1, 15.0)
    await action.return_to_launch()
    await until("return", telemetry.flight_mode(), lambda m: "RETURN" in str(m), 5.0)
    await action.land()
    await until("disarmed", telemetry.armed(), lambda armed: not armed, 90.0)


failure = None
try:
    asyncio.run(main())
except Exception as error:
    failure = f"FAILED: {error!r}"  # without its traceback, which would keep mavsdk_server running
sys.exit(failure)
