# SPDX-License-Identifier: BSD-3-Clause
"""Flies all missions of a folder, each against its golden flight.

A folder holds mission files, ``suite.toml`` (which may be missing) and ``golden/NAME.rec``.
"""
