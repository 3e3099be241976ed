# SPDX-License-Identifier: BSD-3-Clause
"""``python -m benchmarks.conformance``: runs tests of ArduPilot's own suite against an executable (docs/drop-in.md).

The suite is not part of this project: the user names a checkout of ArduPilot. Each test runs in a process and a folder
of its own; on Linux, where it is allowed, in a network namespace of its own, so that several can run at once.
"""
