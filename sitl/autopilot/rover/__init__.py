# SPDX-License-Identifier: BSD-3-Clause
"""The rover's firmware: what only a ground vehicle has."""
