# SPDX-License-Identifier: GPL-3.0-or-later
# mypy: disable-error-code="valid-type"
"""File > Export > Glimmer Scene: the scene file that the command line renders to the same picture as F12."""

from pathlib import Path

import bpy
from bpy_extras.io_utils import ExportHelper

from .. import jobs


class GLIMMER_OT_export_scene(bpy.types.Operator, ExportHelper):
    """Write the scene as it would be rendered now to a file for the command line"""

    bl_idname = "glimmer.export_scene"
    bl_label = "Export Glimmer Scene"

    filename_ext = ".json"
    filter_glob: bpy.props.StringProperty(default="*.json", options={"HIDDEN"})

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        return context.scene.camera is not None and not bpy.app.is_job_running("RENDER")

    def execute(self, context: bpy.types.Context) -> set[str]:
        """Only a render gives a depsgraph with the render's own modifiers and visibility, so one is begun: the job
        writes the file in place of rendering."""
        scene = context.scene
        engine = scene.render.engine
        jobs.export_request["path"] = Path(bpy.path.abspath(self.filepath))
        try:
            scene.render.engine = "GLIMMER"
            bpy.ops.render.render(scene=scene.name, layer=context.view_layer.name)
        except RuntimeError as error:
            self.report({"ERROR"}, str(error).removeprefix("Error: ").strip())
            return {"CANCELLED"}
        finally:
            jobs.export_request.clear()
            scene.render.engine = engine
        self.report({"INFO"}, f"Wrote {self.filepath}")
        return {"FINISHED"}


def _draw_menu(menu: bpy.types.Menu, context: bpy.types.Context) -> None:
    menu.layout.operator(GLIMMER_OT_export_scene.bl_idname, text="Glimmer Scene (.json)")


def register() -> None:
    bpy.utils.register_class(GLIMMER_OT_export_scene)
    bpy.types.TOPBAR_MT_file_export.append(_draw_menu)


def unregister() -> None:
    bpy.types.TOPBAR_MT_file_export.remove(_draw_menu)
    bpy.utils.unregister_class(GLIMMER_OT_export_scene)
