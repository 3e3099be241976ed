# SPDX-License-Identifier: BSD-3-Clause
"""Three copters on one link, by MAVSDK 4: each is found by its system id; two of them fly, one after the other."""

from mavsdk.plugins.action import Action
from mavsdk.plugins.telemetry import Telemetry
from sdk import Session, check, wait

session = Session()
wait("three systems", lambda: len(session.mavsdk.get_systems()) == 3)
systems = {system.get_system_id(): system for system in session.mavsdk.get_systems()}
check("system ids", sorted(systems) == [1, 2, 3], sorted(systems))
telemetry = {number: Telemetry(system) for number, system in systems.items()}
for number, height in ((1, 3.0), (3, 5.0)):
    action = Action(systems[number])
    wait(f"{number} is ready", lambda number=number: telemetry[number].health_all_ok(), 120.0)
    action.set_takeoff_altitude(height)
    action.arm()
    action.takeoff()
for number, height in ((1, 3.0), (3, 5.0)):
    wait(
        f"{number} is at {height:g} m",
        lambda number=number, height=height: abs(telemetry[number].position().relative_altitude_m - height) < 0.5,
        60.0,
    )
check("the second one stands", not telemetry[2].armed() and abs(telemetry[2].position().relative_altitude_m) < 0.5)
for number in (1, 3):
    Action(systems[number]).land()
    wait(f"{number} has landed", lambda number=number: not telemetry[number].armed(), 60.0)
