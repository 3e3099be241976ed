# SPDX-License-Identifier: BSD-3-Clause
"""Parameters, missions in both encodings, AUTO, RTL, reboot, by pymavlink."""

import sys

from pilot import ARMED, Pilot, check

NORTH_12_M = 1078

pilot = Pilot(sys.argv[1])
check("modes of a copter", "GUIDED" in pilot.link.mode_mapping())

pilot.link.param_fetch_one("WPNAV_SPEED")
first = pilot.expect("parameter", ("PARAM_VALUE",), lambda p: p.param_id == "WPNAV_SPEED")
pilot.link.param_set_send("WPNAV_SPEED", 700)
changed = pilot.expect("parameter set", ("PARAM_VALUE",), lambda p: p.param_id == "WPNAV_SPEED")
check("value", changed.param_value == 700, (first.param_value, changed.param_value))
pilot.link.param_fetch_all()
names = set()
while len(names) < first.param_count:
    names.add(pilot.expect(f"parameter {len(names)}", ("PARAM_VALUE",), lambda p: p.param_index < 65535).param_id)

pilot.mav.set_mode_send(1, 1, 5)
pilot.expect("LOITER by SET_MODE", ("HEARTBEAT",), lambda m: m.custom_mode == 5)
pilot.take_off()
start = pilot.expect("global position", ("GLOBAL_POSITION_INT",))
lat, lon = start.lat, start.lon
MISSION = (
    (16, 0, lat, lon, 0), (22, 3, 0, 0, 12), (16, 3, lat + NORTH_12_M, lon, 12), (16, 3, lat, lon, 12),
    (20, 3, 0, 0, 0),
)  # fmt: skip


def upload(whole_numbers):
    pilot.mav.mission_count_send(1, 1, len(MISSION))
    for _ in MISSION:
        seq = pilot.expect("request", ("MISSION_REQUEST",)).seq
        command, frame, x, y, z = MISSION[seq]
        send, k = (pilot.mav.mission_item_int_send, 1) if whole_numbers else (pilot.mav.mission_item_send, 1e-7)
        send(1, 1, seq, frame, command, 0, 1, 0, 0, 0, 0, x * k, y * k, z)
    return pilot.expect("acknowledged", ("MISSION_ACK",)).type


def download(whole_numbers):
    pilot.mav.mission_request_list_send(1, 1)
    items = []
    for seq in range(pilot.expect("count", ("MISSION_COUNT",)).count):
        ask, answer = (
            (pilot.mav.mission_request_int_send, "MISSION_ITEM_INT")
            if whole_numbers
            else (pilot.mav.mission_request_send, "MISSION_ITEM")
        )
        ask(1, 1, seq)
        items.append(pilot.expect(f"item {seq}", (answer,), lambda m: m.seq == seq))  # noqa: B023
    pilot.mav.mission_ack_send(1, 1, 0)
    return items


for whole_numbers in (False, True):
    check("upload", upload(whole_numbers) == 0)
    got = download(whole_numbers)
    check("download", [m.command for m in got] == [m[0] for m in MISSION])
    check("place", abs(got[2].x - MISSION[2][2] * (1 if whole_numbers else 1e-7)) < (1 if whole_numbers else 1e-5))
check("legacy items are remarked on", any("MISSION_ITEM_INT" in text for text in pilot.texts))

pilot.mode("AUTO")
check("set current", pilot.command(224, 2) == 0)
pilot.expect("item 2", ("MISSION_ITEM_REACHED",), lambda m: m.seq == 2, 30.0)
pilot.mav.mission_set_current_send(1, 1, 4)
pilot.expect("current 4", ("MISSION_CURRENT",), lambda m: m.seq == 4)
pilot.mode("RTL")
pilot.wait((), seconds=5.0)
pilot.mode("LAND")
pilot.disarmed()
pilot.mav.mission_clear_all_send(1, 1)
check("cleared", pilot.expect("acknowledged", ("MISSION_ACK",)).type == 0)

pilot.mode("STABILIZE")
pilot.link.arducopter_arm()
pilot.expect("armed", ("HEARTBEAT",), lambda m: m.base_mode & ARMED, 5.0)
pilot.link.arducopter_disarm()
pilot.disarmed(5.0)
pilot.link.reboot_autopilot()
check("reboot", pilot.expect("answer", ("COMMAND_ACK",), lambda a: a.command == 246).result == 0)
pilot.stream(2, "SYSTEM_TIME")
check("the clock began anew", pilot.expect("time", ("SYSTEM_TIME",)).time_boot_ms < 10000)
