# SPDX-License-Identifier: BSD-3-Clause
"""Numbers of MAV_MISSION_RESULT that the protocol itself gives.

(those of items are in ``autopilot.mission.validate``).
"""

ACCEPTED, ERROR, UNSUPPORTED_FRAME, UNSUPPORTED, NO_SPACE, INVALID = range(6)
INVALID_SEQUENCE, DENIED, CANCELLED = 13, 14, 15
