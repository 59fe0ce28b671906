# SPDX-License-Identifier: GPL-3.0-or-later
"""Calls in the wrong order, and messages of each thread."""

from ctypes import byref, c_void_p

from addon.native import structs
from tests.engine.api.misuse import OK, STATE, committed, refused, render_call
from tests.engine.library import Render, engine, functions


def test_commit_wants_camera_and_film(scene: c_void_p) -> None:
    library = functions()
    refused(library.glimmer_scene_commit(scene, 1), STATE, "camera")
    assert library.glimmer_scene_set_camera(scene, byref(engine().init(structs.CameraDesc))) == OK
    refused(library.glimmer_scene_commit(scene, 1), STATE, "film")
    assert library.glimmer_scene_set_film(scene, byref(engine().init(structs.FilmDesc))) == OK
    assert library.glimmer_scene_commit(scene, 1) == OK
    refused(library.glimmer_scene_commit(scene, 1), STATE, "commit")


def test_render_wants_a_committed_scene(scene: c_void_p) -> None:
    out = c_void_p()
    desc = engine().init(structs.RenderDesc)
    refused(functions().glimmer_render_create(scene, byref(desc), byref(out)), STATE, "commit")
    assert not out


def test_order_of_a_render() -> None:
    with Render(committed(), samples=2) as render:
        refused(render_call("wait", render.handle), STATE, "start")
        state = render.save()  # of nothing yet
        render.run()
        refused(render_call("start", render.handle), STATE, "started")
        refused(functions().glimmer_render_load(render.handle, state, len(state)), STATE)
    with Render(committed(), samples=1 << 40) as render:
        render.start()
        refused(render_call("save", render.handle), STATE, "pause")
        refused(render_call("start", render.handle), STATE, "started")


def test_calls_that_change_nothing_in_the_wrong_state() -> None:
    """Pausing what does not run and resuming what is not paused leave everything as it is."""
    with Render(committed(), samples=1) as render:
        for name in ("pause", "resume"):
            assert render_call(name, render.handle) in (OK, STATE)
        assert render.poll().state == structs.State.READY
        render.run()
        for name in ("pause", "resume", "cancel"):
            assert render_call(name, render.handle) in (OK, STATE)
        assert render.poll().state == structs.State.FINISHED
