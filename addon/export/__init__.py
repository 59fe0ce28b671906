# SPDX-License-Identifier: GPL-3.0-or-later
"""From Blender's depsgraph to the scene description: a file for each kind of datablock. Knows no ctypes."""
