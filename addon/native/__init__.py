# SPDX-License-Identifier: GPL-3.0-or-later
"""The engine's C API for Python. Knows the scene description and nothing of Blender."""
