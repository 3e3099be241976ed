# SPDX-License-Identifier: BSD-3-Clause
"""Plants: a vehicle's physics as its autopilot meets it, in this process or at the other end of a link."""
