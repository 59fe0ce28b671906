# SPDX-License-Identifier: GPL-3.0-or-later
"""Rendered shading in a 3D view: the scene is read as for F12, rendered in the background and drawn over the view."""
