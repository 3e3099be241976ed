# SPDX-License-Identifier: BSD-3-Clause
"""Parameters, missions, MAVLink FTP, logs, commands and a GUIDED flight by pymavlink over a bad link, with retries."""

import os
import struct
import sys
import tempfile
import time
from functools import partial

from pilot import ARMED, Pilot, check
from pymavlink.mavftp import MAVFTP

pilot = Pilot(sys.argv[1])
TRIES = 20


def ask(what, send, kinds, condition=lambda m: True, seconds=1.0):
    """Send until the answer comes."""
    for _ in range(TRIES):
        send()
        answer = pilot.wait(kinds, condition, seconds)
        if answer is not None:
            return answer
    check(what, False)


def command(number, *params):
    send = partial(pilot.mav.command_long_send, 1, 1, number, 0, *params, *(0,) * (7 - len(params)))
    answer = ask(f"command {number}", send, ("COMMAND_ACK",), lambda a: a.command == number)
    check(f"command {number}", answer.result == 0, answer.result)


def collect(what, begin, again, kinds, place, count, most=60):
    """All of ``count(message)`` pieces; ``again(runs)`` asks for runs of those that are missing."""
    found, wanted, start = {}, None, time.monotonic()
    begin()
    while wanted is None or len(found) < wanted:
        message = pilot.wait(kinds, seconds=1.0)
        if message is not None:
            wanted = count(message) if wanted is None else wanted
            found[place(message)] = message
            continue
        if time.monotonic() - start > 170:
            check(what, False, len(found))
        runs = []
        for k in range(wanted or 0):
            if k not in found:
                if runs and runs[-1][1] == k:
                    runs[-1][1] = k + 1
                else:
                    runs.append([k, k + 1])
        if found:
            again(runs[:most])
        else:
            begin()
    check(what, True, f"{len(found)} in {time.monotonic() - start:.0f} s")
    return found


def read(runs):
    for first, end in runs:
        for k in range(first, min(end, first + 20)):
            pilot.mav.param_request_read_send(1, 1, b"", k)


collect(
    "parameters", pilot.link.param_fetch_all, read, ("PARAM_VALUE",), lambda m: m.param_index, lambda m: m.param_count
)

for value in (700.0, 800.0):
    ask(
        "parameter", lambda: pilot.link.param_set_send("WPNAV_SPEED", value), ("PARAM_VALUE",),  # noqa: B023
        lambda p: p.param_id == "WPNAV_SPEED" and p.param_value == value,  # noqa: B023
    )  # fmt: skip

MISSION = [(16, 0, -353632610 + 100 * k, 1491652300, 20 + k) for k in range(40)]


def item(seq):
    kind, frame, x, y, z = MISSION[seq]
    pilot.mav.mission_item_int_send(1, 1, seq, frame, kind, 0, 1, 0, 0, 0, 0, x, y, z)


def upload():
    say = partial(pilot.mav.mission_count_send, 1, 1, len(MISSION))
    while True:
        answer = ask("upload", say, ("MISSION_REQUEST", "MISSION_ACK"))
        if answer.get_type() == "MISSION_ACK":
            return answer.type
        say = partial(item, answer.seq)


start = time.monotonic()
check("upload", upload() == 0, f"{time.monotonic() - start:.0f} s")
start = time.monotonic()
count = ask("count", lambda: pilot.mav.mission_request_list_send(1, 1), ("MISSION_COUNT",)).count
for seq in range(count):
    got = ask(
        "item", lambda: pilot.mav.mission_request_int_send(1, 1, seq), ("MISSION_ITEM_INT",), lambda m: m.seq == seq  # noqa: B023
    )  # fmt: skip
    check(f"item {seq}", seq == 0 or got.x == MISSION[seq][2], got.x)
pilot.mav.mission_ack_send(1, 1, 0)
check("download", count == len(MISSION), f"{time.monotonic() - start:.0f} s")

# MAVLink FTP, by pymavlink's own client
start = time.monotonic()
with tempfile.TemporaryDirectory() as folder:
    target = os.path.join(folder, "param.pck")
    for _ in range(5):
        ftp = MAVFTP(pilot.link, target_system=1, target_component=1)
        ftp.cmd_get(["@PARAM/param.pck", target])
        ftp.process_ftp_reply("OpenFileRO", timeout=60)
        if os.path.exists(target):
            break
    with open(target, "rb") as file:
        packed = file.read()
check("FTP", struct.unpack("<H", packed[:2])[0] == 0x671B, f"{len(packed)} bytes in {time.monotonic() - start:.0f} s")

# a GUIDED flight
command(511, 32, 100_000)
command(511, 1, 500_000)
command(176, 1, 4)
pilot.expect("ready to arm", ("SYS_STATUS",), lambda s: s.onboard_control_sensors_health & (1 << 28), 90.0)
command(400, 1)
pilot.expect("armed", ("HEARTBEAT",), lambda m: m.base_mode & ARMED, 5.0)
command(22, 0, 0, 0, 0, 0, 0, 10)
pilot.expect("at height", ("LOCAL_POSITION_NED",), lambda p: p.z < -9.5, 30.0)
go = partial(pilot.mav.set_position_target_local_ned_send, 0, 1, 1, 1, 0xDF8, 15, 5, -12, 0, 0, 0, 0, 0, 0, 0, 0)
ask("there", go, ("LOCAL_POSITION_NED",), lambda p: abs(p.x - 15) < 0.5 and abs(p.y - 5) < 0.5, 4.0)
command(176, 1, 9)
pilot.disarmed()

# the log of the flight
entry = ask("log", lambda: pilot.mav.log_request_list_send(1, 1, 0, 0xFFFF), ("LOG_ENTRY",))
pieces = -(-entry.size // 90)
logged = collect(
    f"log of {entry.size} bytes",
    lambda: pilot.mav.log_request_data_send(1, 1, entry.id, 0, entry.size),
    lambda runs: [pilot.mav.log_request_data_send(1, 1, entry.id, a * 90, (b - a) * 90) for a, b in runs],
    ("LOG_DATA",), lambda m: m.ofs // 90, lambda m: pieces,
)  # fmt: skip
check("its beginning", bytes(logged[0].data[:3]) == b"\xa3\x95\x80")
