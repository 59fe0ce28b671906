# SPDX-License-Identifier: GPL-3.0-or-later
"""The add-on's zip: what is in it, and that it installs, renders and goes again in the hosts we support."""

import ast
import os
import re
import subprocess
import zipfile
from pathlib import Path

import pytest

import build

ROOT = Path(__file__).resolve().parent.parent

# Runs inside Blender. argv: the zip, how to install it, the picture to write.
INSTALL_AND_RENDER = """
import sys
import bpy

zip_path, how, picture = sys.argv[sys.argv.index("--") + 1:]
assert "glimmer" not in sys.modules
if how == "extension":
    # The repository's own folder lies in the isolated profile.
    bpy.ops.extensions.package_install_files(filepath=zip_path, repo="user_default", enable_on_install=True)
    name = "bl_ext.user_default.glimmer"
else:
    bpy.ops.preferences.addon_install(filepath=zip_path)
    bpy.ops.preferences.addon_enable(module="glimmer")
    name = "glimmer"
assert name in bpy.context.preferences.addons, list(bpy.context.preferences.addons.keys())
folder = sys.modules[name].__file__
assert folder.startswith(PROFILE), folder
scene = bpy.context.scene
scene.render.engine = "GLIMMER"
scene.glimmer.samples = 2
scene.render.resolution_x, scene.render.resolution_y, scene.render.resolution_percentage = 32, 18, 100
bpy.ops.render.render()
scene.render.image_settings.file_format = "PNG"
bpy.data.images["Render Result"].save_render(picture, scene=scene)
loaded = [line.split()[-1] for line in open("/proc/self/maps") if "libglimmer.so" in line]
assert loaded and all(path.startswith(PROFILE) for path in loaded), loaded
bpy.ops.preferences.addon_disable(module=name)
assert not hasattr(bpy.types.Scene, "glimmer")
"""


# Runs inside Blender. argv: the zip, which way it is installed first, a picture's path.
INSTALL_TWICE = """
import sys
import bpy

zip_path, first, picture = sys.argv[sys.argv.index("--") + 1:]
names = {"extension": "bl_ext.user_default.glimmer", "addon": "glimmer"}
second = next(how for how in names if how != first)

def install(how):
    if how == "extension":
        bpy.ops.extensions.package_install_files(filepath=zip_path, repo="user_default", enable_on_install=True)
    else:
        bpy.ops.preferences.addon_install(filepath=zip_path)
        bpy.ops.preferences.addon_enable(module=names[how])

def render():
    bpy.context.scene.render.engine = "GLIMMER"
    bpy.context.scene.glimmer.samples = 2
    render = bpy.context.scene.render
    render.resolution_x, render.resolution_y, render.resolution_percentage = 32, 18, 100
    bpy.ops.render.render()

def owners():
    types = [*bpy.types.RenderEngine.__subclasses__(), *bpy.types.Panel.__subclasses__()]
    modules = [cls.__module__ for cls in types if cls.is_registered]
    return sorted({name for name in names.values() for module in modules if module.startswith(name + ".")})

install(first)
alone = owners()
assert len(alone) == 1, alone
print("SECOND", file=sys.stderr, flush=True)
install(second)
assert owners() == alone, owners()
render()
bpy.ops.preferences.addon_disable(module=names[second])
assert owners() == alone, owners()
render()
bpy.ops.preferences.addon_disable(module=names[first])
assert owners() == [] and not hasattr(bpy.types.Scene, "glimmer")
bpy.ops.preferences.addon_enable(module=names[second])
assert len(owners()) == 1 and owners() != alone, owners()
render()
bpy.data.images["Render Result"].save_render(picture, scene=bpy.context.scene)
"""


@pytest.fixture(scope="session")
def zip_path() -> Path:
    build.build()
    return build.package()


def test_the_zip_holds_the_add_on_its_library_and_its_licence(zip_path: Path) -> None:
    with zipfile.ZipFile(zip_path) as archive:
        assert archive.testzip() is None
        names = archive.namelist()
        library = archive.read("glimmer/lib/libglimmer.so")
        sources = {name: archive.read(name) for name in names if name.endswith(".py")}
    assert {
        "glimmer/__init__.py",
        "glimmer/blender_manifest.toml",
        "glimmer/LICENSE",
        "glimmer/lib/LICENSE.embree",
    } <= set(names)
    assert all(name.startswith("glimmer/") for name in names)
    assert not [name for name in names if "__pycache__" in name or name.endswith((".pyc", ".blend"))]
    assert library == build.LIBRARY.read_bytes()
    foreign = re.compile(rb"^\s*(?:import|from) (?:dask|distributed|OpenImageIO|engine)\b", re.MULTILINE)
    assert "glimmer/cluster/render.py" in sources
    assert [name for name, text in sources.items() if foreign.search(text)] == [], "Blender has none of them"


def test_the_same_files_give_the_same_zip(zip_path: Path) -> None:
    first = zip_path.read_bytes()
    zip_path.unlink()
    assert build.package().read_bytes() == first


def test_the_version_is_the_same_everywhere() -> None:
    tree = ast.parse((ROOT / "addon" / "__init__.py").read_text())
    infos = [
        node.value for node in tree.body if isinstance(node, ast.Assign) and ast.unparse(node.targets[0]) == "bl_info"
    ]
    bl_info = ast.literal_eval(infos[0])
    cmake = re.search(r"project\(glimmer VERSION ([\d.]+)", (ROOT / "engine" / "CMakeLists.txt").read_text())
    assert cmake is not None
    assert cmake.group(1) == ".".join(map(str, bl_info["version"])) == build.addon_version()


def install_and_render(
    command: list[str], zip_path: Path, how: str, folder: Path, what: str = INSTALL_AND_RENDER
) -> str:
    """What Blender said on the error channel."""
    profile, picture, script = folder / "profile", folder / "picture.png", folder / "install.py"
    (profile / "scripts" / "addons").mkdir(parents=True)
    script.write_text(f"PROFILE = {str(profile)!r}\n{what}")
    env = {key: value for key, value in os.environ.items() if not key.startswith("GLIMMER_")}
    env["BLENDER_USER_RESOURCES"] = str(profile)
    env["BLENDER_USER_CONFIG"] = str(profile / "config")
    env["BLENDER_USER_SCRIPTS"] = str(profile / "scripts")
    result = subprocess.run(
        [*command, str(script), "--", str(zip_path), how, str(picture)],
        env=env,
        capture_output=True,
        text=True,
        check=False,
        timeout=180,
    )
    assert result.returncode == 0, result.stdout[-3000:] + result.stderr[-3000:]
    assert picture.read_bytes().startswith(b"\x89PNG")
    return result.stderr


def test_installs_as_an_add_on_in_blender(zip_path: Path, blender: Path, tmp_path: Path) -> None:
    command = [str(blender), "-b", "--factory-startup", "--python-exit-code", "1", "--python"]
    install_and_render(command, zip_path, "addon", tmp_path)


@pytest.mark.parametrize("module", ["bpy_python", "newest_python"])
@pytest.mark.parametrize("how", ["addon", "extension"])
def test_installs_in_the_bpy_module(
    request: pytest.FixtureRequest, zip_path: Path, module: str, tmp_path: Path, how: str
) -> None:
    install_and_render([str(request.getfixturevalue(module))], zip_path, how, tmp_path)


@pytest.mark.parametrize("module", ["bpy_python", "newest_python"])
@pytest.mark.parametrize("first", ["addon", "extension"])
def test_of_two_installed_the_second_says_one_sentence_and_does_nothing(
    request: pytest.FixtureRequest, zip_path: Path, module: str, tmp_path: Path, first: str
) -> None:
    python = str(request.getfixturevalue(module))
    said = install_and_render([python], zip_path, first, tmp_path, INSTALL_TWICE).partition("SECOND\n")[2].splitlines()
    names = ("glimmer", "bl_ext.user_default.glimmer")
    other, own = names if first == "addon" else reversed(names)
    assert len(said) == 1, said
    assert said[0].startswith(f"Glimmer is installed twice: {other} (/")
    assert f" is at work, and {own} (/" in said[0]
