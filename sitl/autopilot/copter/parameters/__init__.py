# SPDX-License-Identifier: BSD-3-Clause
"""Parameters that only the copter has, or that mean something else there; one file a group."""
