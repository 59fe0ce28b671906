# SPDX-License-Identifier: GPL-3.0-or-later
"""The scene as plain data, between Blender's depsgraph and the engine: knows neither."""
