# SPDX-License-Identifier: BSD-3-Clause
"""ArduPilot's JSON simulation interface, both ends: servo pulses one way, the body's motion the other.

https://ardupilot.org/dev/docs/sitl-with-JSON.html. The modules here know no socket and no clock.
"""
