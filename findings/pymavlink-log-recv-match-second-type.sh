#!/usr/bin/env bash
# SPDX-License-Identifier: BSD-3-Clause
# pymavlink 2.4.50, recv_match(type=...) of a log file: the type of the first call decides which messages all later calls look at.
# A later call for another type skips the messages of that type and reads to the end. So "the first GPS message for the time, then all
# ATT" finds no ATT in a DataFlash log, and in a telemetry log (.tlog) only what comes after the last GPS message; nothing is said,
# None is what the end of a log gives. rewind() in between helps, at the cost of beginning anew.
# Seen: the lines below. Fails if the later call finds all messages, or rewind() does not help.
set -euo pipefail
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
python3 -m venv "$work/venv"
"$work/venv/bin/pip" install -q pymavlink==2.4.50
MAVLINK20=1 "$work/venv/bin/python" - "$work" <<'PYTHON'
import struct
import sys

from pymavlink import mavutil

COUNT = 10
dialect = mavutil.mavlink
sender = dialect.MAVLink(None, srcSystem=1, srcComponent=1)
with open(f"{sys.argv[1]}/flight.tlog", "wb") as file:
    for k in range(COUNT):
        gps = dialect.MAVLink_gps_raw_int_message(k * 100_000, 3, -353632610, 1491652300, 584000, 100, 100, 0, 0, 10)
        attitude = dialect.MAVLink_attitude_message(k * 100, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0)
        for message in (gps, attitude):
            file.write(struct.pack(">Q", 1_700_000_000_000_000 + k * 100_000) + message.pack(sender))

record = struct.Struct("<BBB")


def described(number, name, layout, columns, size):
    head = record.pack(0xA3, 0x95, 0x80)
    return head + struct.pack("<BB4s16s64s", number, size + 3, name.encode(), layout.encode(), columns.encode())


with open(f"{sys.argv[1]}/flight.bin", "wb") as file:
    file.write(described(0x80, "FMT", "BBnNZ", "Type,Length,Name,Format,Columns", 86))
    file.write(described(1, "GPS", "QBIHLL", "TimeUS,Status,GMS,GWk,Lat,Lng", 23))
    file.write(described(2, "ATT", "Qcc", "TimeUS,Roll,Pitch", 12))
    for k in range(COUNT):
        now = 1_000_000 + k * 100_000
        file.write(record.pack(0xA3, 0x95, 1) + struct.pack("<QBIHii", now, 3, 1000 + k * 100, 2290, -353632610, 1491652300))
        file.write(record.pack(0xA3, 0x95, 2) + struct.pack("<Qhh", now, 0, 0))


def all_of(log, kind):
    found = 0
    while log.recv_match(type=kind) is not None:
        found += 1
    return found


for name, gps, attitude, expected in (("flight.tlog", "GPS_RAW_INT", "ATTITUDE", 1), ("flight.bin", "GPS", "ATT", 0)):
    log = mavutil.mavlink_connection(f"{sys.argv[1]}/{name}")
    assert log.recv_match(type=gps) is not None
    second = all_of(log, attitude)
    log.rewind()
    alone = all_of(log, attitude)
    print(f"{name}: {COUNT} {attitude}; found after one {gps}: {second}; after rewind(): {alone}")
    assert second == expected and alone == COUNT
PYTHON
