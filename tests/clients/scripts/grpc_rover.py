# SPDX-License-Identifier: BSD-3-Clause
"""The gRPC generations of MAVSDK (``mavsdk<4`` and ``mavsdk-grpc``) with a rover: off-board, go to, mission, RTL."""

import asyncio
import math
import sys
from contextlib import aclosing

try:
    import mavsdk_grpc as mavsdk
    from mavsdk_grpc.action import ActionError
    from mavsdk_grpc.mission_raw import MissionItem
    from mavsdk_grpc.offboard import PositionNedYaw, VelocityBodyYawspeed, VelocityNedYaw
except ImportError:
    import mavsdk
    from mavsdk.action import ActionError
    from mavsdk.mission_raw import MissionItem
    from mavsdk.offboard import PositionNedYaw, VelocityBodyYawspeed, VelocityNedYaw

from tests.ports import free_port

NORTH_10_M = 9e-5


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
    rover = mavsdk.System(port=free_port())
    await rover.connect(system_address=sys.argv[1])
    action, telemetry, offboard, mission = rover.action, rover.telemetry, rover.offboard, rover.mission_raw
    await until("connected", rover.core.connection_state(), lambda s: s.is_connected)
    await telemetry.set_rate_position(5.0)
    await telemetry.set_rate_velocity_ned(5.0)
    await telemetry.set_rate_position_velocity_ned(5.0)
    await telemetry.set_rate_home(1.0)
    await telemetry.set_rate_rc_status(2.0)  # SYS_STATUS, which health is made of
    await until("position", telemetry.status_text(), lambda s: s.text.endswith("is using GPS"), 90.0)
    await until("ready to arm", telemetry.health(), lambda h: h.is_armable and h.is_home_position_ok)
    await rover.param.set_param_float("WP_SPEED", 1.0)
    await action.arm()
    try:
        await action.takeoff()
        raise Failed("a take-off must be refused")
    except ActionError as error:
        print("ok: refused,", error)
    start = await until("start", telemetry.position(), lambda p: True)

    await offboard.set_velocity_ned(VelocityNedYaw(0.8, 0.0, 0.0, 0.0))
    await offboard.start()
    await asyncio.sleep(8.0)
    await until("velocity", telemetry.velocity_ned(), lambda v: abs(v.north_m_s - 0.8) < 0.15, 5.0)
    await offboard.set_velocity_body(VelocityBodyYawspeed(-0.6, 0.0, 0.0, 0.0))
    await until("backwards", telemetry.velocity_ned(), lambda v: abs(v.north_m_s + 0.6) < 0.15, 8.0)
    await offboard.set_position_ned(PositionNedYaw(10.0, 0.0, 0.0, 0.0))

    def near(north, east):
        return lambda p: math.dist((p.position.north_m, p.position.east_m), (north, east)) < 2.5

    await until("place", telemetry.position_velocity_ned(), near(10.0, 0.0), 40.0)
    await offboard.stop()
    await until("hold", telemetry.flight_mode(), lambda m: "HOLD" in str(m), 5.0)
    await action.goto_location(
        start.latitude_deg + NORTH_10_M, start.longitude_deg + NORTH_10_M, start.absolute_altitude_m, 0.0
    )
    await until("goto", telemetry.position_velocity_ned(), near(10.0, 8.2), 60.0)

    place = (round(start.latitude_deg * 1e7), round(start.longitude_deg * 1e7))
    items = [
        MissionItem(0, 3, 16, 1, 1, 0, 0, 0, 0, *place, 0.0, 0),
        MissionItem(1, 3, 16, 0, 1, 0, 0, 0, 0, place[0] + 900, place[1], 0.0, 0),
        MissionItem(2, 3, 16, 0, 1, 0, 0, 0, 0, *place, 0.0, 0),
    ]
    await mission.upload_mission(items)
    assert len(await mission.download_mission()) == len(items)
    await mission.start_mission()
    await until("on the way to item 2", mission.mission_progress(), lambda m: m.current == 2, 60.0)
    await mission.pause_mission()
    await until("pause", telemetry.velocity_ned(), lambda v: math.hypot(v.north_m_s, v.east_m_s) < 0.1, 15.0)
    await action.return_to_launch()
    await until("return", telemetry.flight_mode(), lambda m: "RETURN" in str(m), 5.0)
    await until("home", telemetry.position_velocity_ned(), near(0.0, 0.0), 60.0)
    await action.hold()
    await action.disarm()
    await until("disarmed", telemetry.armed(), lambda armed: not armed, 5.0)


failure = None
try:
    asyncio.run(main())
except Exception as error:
    failure = f"FAILED: {error!r}"  # without its traceback, which would keep mavsdk_server running
sys.exit(failure)
