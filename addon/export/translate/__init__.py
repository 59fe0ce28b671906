# SPDX-License-Identifier: GPL-3.0-or-later
"""Blender's nodes as operations of shader programs, a file for each family of nodes."""
