# SPDX-License-Identifier: BSD-3-Clause
"""The rover's modes: one mode, one file, named as drivers name it."""
