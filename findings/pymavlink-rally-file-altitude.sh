#!/usr/bin/env bash
# SPDX-License-Identifier: BSD-3-Clause
# pymavlink 2.4.50: two loaders of the same rally file (RALLY lines: latitude, longitude, altitude [m], ...) disagree by a factor
# of 1000 in altitude. MAVRallyLoader gives RALLY_POINT with alt = 60. MissionItemProtocol_Rally, which is for uploads by the
# mission protocol, gives MISSION_ITEM_INT with z = 60000; z is in metres in that message, so the point is 60 km high.
# Seen: the lines below. Fails if either loader changes.
set -euo pipefail
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
python3 -m venv "$work/venv"
"$work/venv/bin/pip" install -q pymavlink==2.4.50
printf 'RALLY -35.360000 149.160000 60.000000 40.000000 0.000000 0\n' > "$work/points.rally"
MAVLINK20=1 "$work/venv/bin/python" - "$work/points.rally" <<'PYTHON'
import sys
from pymavlink import mavwp

old, new = mavwp.MAVRallyLoader(), mavwp.MissionItemProtocol_Rally()
old.load(sys.argv[1])
new.load(sys.argv[1])
point, item = old.rally_point(0), new.item(0)
print(f"MAVRallyLoader: alt {point.alt} m; MissionItemProtocol_Rally: z {item.z} m, frame {item.frame}")
assert point.alt == 60
assert item.z == 60000.0 and item.frame == 3
PYTHON
