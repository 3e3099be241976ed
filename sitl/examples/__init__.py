# SPDX-License-Identifier: BSD-3-Clause
"""Short programs that come with the package; ``sitl examples`` lists and copies them (``cli/example_programs.py``).

Those that speak MAVLink know nothing of the simulator: they are what one runs against a real vehicle. An example
that needs matplotlib draws a picture of its name into the current folder (docs/gallery.md shows them).
"""
