# SPDX-License-Identifier: BSD-3-Clause
"""Policies that try to be paid for what they should not do, and what they get."""
