# SPDX-License-Identifier: GPL-3.0-or-later
"""A frame rendered by the machines of a cluster in place of this one; see docs/farm.md.

Blender's Python has no Dask: the command `glimmer farm` of a checkout does the work, and we show what it writes.
"""
