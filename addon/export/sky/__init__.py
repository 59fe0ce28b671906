# SPDX-License-Identifier: GPL-3.0-or-later
"""Blender's sky models as pictures of all directions, and their suns. None of these files knows Blender."""
