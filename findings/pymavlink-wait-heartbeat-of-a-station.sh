#!/usr/bin/env bash
# SPDX-License-Identifier: BSD-3-Clause
# pymavlink 2.4.50: wait_heartbeat() returns on the HEARTBEAT of anybody, also of another ground station on the link. Only a
# vehicle's sets target_system, so after a station's it is still 0: everybody. A script that goes on with
# `command_long_send(connection.target_system, ...)`, as most examples do, then commands all vehicles of the link.
# Seen: the line below. Fails if wait_heartbeat() waits for a vehicle, or names one.
set -euo pipefail
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
python3 -m venv "$work/venv"
"$work/venv/bin/pip" install -q pymavlink==2.4.50
"$work/venv/bin/python" - <<'PYTHON'
import socket
from pymavlink import mavutil

with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as probe:
    probe.bind(("127.0.0.1", 0))
    port = probe.getsockname()[1]
listener = mavutil.mavlink_connection(f"udpin:127.0.0.1:{port}")
station = mavutil.mavlink_connection(f"udpout:127.0.0.1:{port}", source_system=255, source_component=190)
station.mav.heartbeat_send(mavutil.mavlink.MAV_TYPE_GCS, mavutil.mavlink.MAV_AUTOPILOT_INVALID, 0, 0, 4)
heartbeat = listener.wait_heartbeat(timeout=10)
print(f"wait_heartbeat returned type {heartbeat.type} of system {heartbeat.get_srcSystem()}; target_system {listener.target_system}")
assert heartbeat.type == mavutil.mavlink.MAV_TYPE_GCS
assert listener.target_system == 0
PYTHON
