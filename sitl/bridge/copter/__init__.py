# SPDX-License-Identifier: BSD-3-Clause
"""What only the copter says and understands on MAVLink."""
