# SPDX-License-Identifier: BSD-3-Clause
"""A plain asyncio script on MAVSDK 4.x: take off, fly by velocity set-points (off-board, GUIDED in ArduPilot), land.

Nothing here knows of the simulator: it is what one would run against a real ArduPilot vehicle.

    python examples/mavsdk_offboard.py [CONNECTION_URL]        (default udpin://0.0.0.0:14540)
"""

import asyncio
import sys
from contextlib import aclosing

try:
    from mavsdk import ComponentType
    from mavsdk.asyncio import Configuration, Mavsdk
    from mavsdk.asyncio.plugins.action import ActionAsync
    from mavsdk.asyncio.plugins.offboard import OffboardAsync
    from mavsdk.asyncio.plugins.telemetry import TelemetryAsync
    from mavsdk.plugins.offboard import VelocityBodyYawspeed, VelocityNedYaw
except ModuleNotFoundError as error:
    raise SystemExit(f"{error.name} is missing: pip install 'mavsdk>=4'") from None

ALTITUDE_M = 10.0

LEGS = (
    ("3 m/s north, nose north", VelocityNedYaw(3.0, 0.0, 0.0, 0.0), 5.0),
    ("3 m/s east, climbing at 1 m/s, nose east", VelocityNedYaw(0.0, 3.0, -1.0, 90.0), 5.0),
    ("3 m/s ahead, turning at 30 deg/s", VelocityBodyYawspeed(3.0, 0.0, 0.0, 30.0), 12.0),
    ("stop", VelocityNedYaw(0.0, 0.0, 0.0, 90.0), 4.0),
)
"""What to do, the set-point, and for how long [s]. MAVSDK sends the last set-point again every 50 ms."""


async def first(stream, condition):
    """The first value of a telemetry stream for which ``condition`` holds."""
    async with aclosing(stream):  # ends the subscription before the library is closed
        async for value in stream:
            if condition(value):
                return value


async def say_where(telemetry: TelemetryAsync, what: str) -> None:
    """Print position and velocity."""
    now = await telemetry.position_velocity_ned()
    p, v = now.position, now.velocity
    print(
        f"{what:42s} at ({p.north_m:6.1f}, {p.east_m:6.1f}, {p.down_m:6.1f}) m,"
        f" ({v.north_m_s:5.2f}, {v.east_m_s:5.2f}, {v.down_m_s:5.2f}) m/s",
        flush=True,
    )


async def fly(url: str) -> None:
    """Fly the legs."""
    configuration = Configuration.create_with_component_type(ComponentType.GROUND_STATION)
    async with Mavsdk(configuration) as mavsdk:
        await mavsdk.add_any_connection(url)
        system = await mavsdk.first_autopilot(30.0)
        if system is None:
            raise SystemExit(f"no autopilot found on {url}")
        action, offboard, telemetry = ActionAsync(system), OffboardAsync(system), TelemetryAsync(system)
        await telemetry.set_rate_position(5.0)
        await telemetry.set_rate_position_velocity_ned(10.0)
        await telemetry.set_rate_health(2.0)
        async with asyncio.timeout(120.0):
            await first(telemetry.subscribe_health(), lambda h: h.is_global_position_ok and h.is_armable)

        await action.set_takeoff_altitude(ALTITUDE_M)
        await action.arm()
        await action.takeoff()
        async with asyncio.timeout(30.0):
            await first(telemetry.subscribe_position(), lambda p: p.relative_altitude_m > ALTITUDE_M - 0.5)
        await say_where(telemetry, "at altitude")

        await offboard.set_velocity_ned(VelocityNedYaw(0.0, 0.0, 0.0, 0.0))
        await offboard.start()
        for what, setpoint, seconds in LEGS:
            if isinstance(setpoint, VelocityBodyYawspeed):
                await offboard.set_velocity_body(setpoint)
            else:
                await offboard.set_velocity_ned(setpoint)
            await asyncio.sleep(seconds)
            await say_where(telemetry, what)
        await offboard.stop()

        await action.land()
        async with asyncio.timeout(90.0):
            await first(telemetry.subscribe_armed(), lambda armed: not armed)
        print("landed and disarmed", flush=True)


if __name__ == "__main__":
    asyncio.run(fly(sys.argv[1] if len(sys.argv) > 1 else "udpin://0.0.0.0:14540"))
