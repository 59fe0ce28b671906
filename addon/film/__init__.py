# SPDX-License-Identifier: GPL-3.0-or-later
"""From the engine's film to Blender's render result."""
