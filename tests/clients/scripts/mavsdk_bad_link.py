# SPDX-License-Identifier: BSD-3-Clause
"""Parameters, missions, MAVLink FTP, logs and a flight by MAVSDK 4 over a bad link; what it gives up is tried again."""

import sys
import time

from mavsdk.plugins.ftp import Ftp
from mavsdk.plugins.log_files import LogFiles
from mavsdk.plugins.mission_raw import MissionItem, MissionRaw
from mavsdk.plugins.param import Param
from sdk import Session, check, wait

TRIES = 15


def insist(what, call, *arguments):
    """Call until it succeeds."""
    start = time.monotonic()
    for attempt in range(1, TRIES + 1):
        try:
            result = call(*arguments)
        except Exception as error:
            print(f"   # {what}: {str(error)[:60]}", flush=True)
            time.sleep(0.5)
        else:
            check(what, True, f"{time.monotonic() - start:.1f} s, {attempt} tries")
            return result
    check(what, False)
    sys.exit(1)


session = Session()
action, telemetry = session.action, session.telemetry
param = Param(session.system)
mission = MissionRaw(session.system)
for name, rate in (("position", 5), ("home", 1), ("health", 2), ("landed_state", 2)):
    insist(f"rate of {name}", getattr(telemetry, f"set_rate_{name}"), float(rate))
wait("position", lambda: telemetry.health().is_global_position_ok and telemetry.health().is_home_position_ok, 90.0)
wait("ready to arm", lambda: telemetry.health().is_armable, 60.0)

insist("a parameter is set", param.set_param_float, "WPNAV_SPEED", 700.0)
insist("a parameter is read", param.get_param_float, "WPNAV_SPEED")

home = telemetry.home()
lat, lon = round(home.latitude_deg * 1e7), round(home.longitude_deg * 1e7)
items = [MissionItem(k, 3, 16, int(k == 0), 1, 0.0, 0.0, 0.0, 0.0, lat + 100 * k, lon, 10.0, 0) for k in range(12)]
insist("mission upload", mission.upload_mission, items)
got = insist("mission download", mission.download_mission)
places, wanted = [i.x - lat for i in got[1:]], [i.x - lat for i in items[1:]]
check(f"the same: {places}", places == wanted)

ftp = Ftp(session.system)
listed = insist("FTP list", ftp.list_directory, "@SYS").entries
check("its files", "uarts.txt" in [entry.name for entry in listed])

insist("arm", action.arm)
insist("take-off", action.takeoff)
wait("in the air", lambda: telemetry.position().relative_altitude_m > 1.5, 60.0)
place = telemetry.position()
insist("goto", action.goto_location, home.latitude_deg + 1e-4, home.longitude_deg, place.absolute_altitude_m + 5, 0.0)
wait("there", lambda: abs(telemetry.position().latitude_deg - home.latitude_deg - 1e-4) < 1e-5, 60.0)
insist("land", action.land)
wait("disarmed", lambda: not telemetry.armed(), 90.0)

logs = LogFiles(session.system)
entries = insist("log list", logs.get_entries)
check("a log", entries and entries[0].size_bytes > 1000, entries)
session.mavsdk.destroy()
