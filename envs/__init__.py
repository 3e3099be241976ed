# SPDX-License-Identifier: BSD-3-Clause
"""Gymnasium environments. None is registered yet."""
