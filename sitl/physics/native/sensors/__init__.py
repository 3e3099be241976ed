# SPDX-License-Identifier: BSD-3-Clause
"""Sensor models: from truth to what the autopilot may see, with noise, bias, drift, delay and steps."""
