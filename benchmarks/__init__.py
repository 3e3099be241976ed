# SPDX-License-Identifier: BSD-3-Clause
"""Speed of the simulator on this machine: ``python -m benchmarks`` prints every value."""
