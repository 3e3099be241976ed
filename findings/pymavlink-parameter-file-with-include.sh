#!/usr/bin/env bash
# SPDX-License-Identifier: BSD-3-Clause
# pymavlink 2.4.50, MAVParmDict.load: ArduPilot's own default files (Tools/autotest/default_params) have lines `@include FILE` and
# `NAME VALUE @READONLY`. The first raises ValueError after the lines before it have been taken, so that the caller who
# catches it has half a file. The second is printed as an invalid line and left out, and load() still returns True.
# Seen: the lines below. Fails if either kind of line is treated otherwise.
set -euo pipefail
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
python3 -m venv "$work/venv"
"$work/venv/bin/pip" install -q pymavlink==2.4.50
printf 'WPNAV_SPEED 500\n@include more.parm\nRTL_ALT 2000\n' > "$work/include.parm"
printf 'WPNAV_SPEED 500 @READONLY\nRTL_ALT 2000\n' > "$work/readonly.parm"
"$work/venv/bin/python" - "$work" <<'PYTHON'
import sys
from pymavlink import mavparm

taken = mavparm.MAVParmDict()
try:
    taken.load(f"{sys.argv[1]}/include.parm")
    raised = None
except ValueError as error:
    raised = error
print(f"@include: {raised!r}; taken before it: {dict(taken)}")
assert raised is not None and dict(taken) == {"WPNAV_SPEED": 500.0}
taken = mavparm.MAVParmDict()
said = taken.load(f"{sys.argv[1]}/readonly.parm")
print(f"@READONLY: load() returned {said}; taken: {dict(taken)}")
assert said is True and dict(taken) == {"RTL_ALT": 2000.0}
PYTHON
