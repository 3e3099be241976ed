# SPDX-License-Identifier: BSD-3-Clause
"""MAVLink in the compiled core: messages as records, frames, and what a link to one client keeps."""
