# SPDX-License-Identifier: BSD-3-Clause
"""An environment's end of MAVLink: connections, what a vehicle says, set-points, getting ready."""
