# SPDX-License-Identifier: BSD-3-Clause
"""What only the rover says and understands on MAVLink."""
