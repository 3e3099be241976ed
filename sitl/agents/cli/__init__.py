# SPDX-License-Identifier: BSD-3-Clause
"""Subcommands of ``sitl`` that learn and play (``sitl.cli.command_list``)."""
