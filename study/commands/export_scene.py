"""``ocularist export-scene``: a still's scene in open formats, for other renderers and engines."""

from __future__ import annotations

import argparse
from typing import Final

from study.commands.eye_arguments import add_picture
from study.commands.eye_options import spec_of, viewpoint_of
from study.commands.places import new_folder

HELP = "write a scene in open formats"
DESCRIPTION = (
    "Write what a still with the same options shows: meshes (PLY), textures (PNG, EXR), camera "
    "(JSON), surroundings (EXR), an index (scene.json), and both eyes with all LoDs as glTF 2.0 "
    "(eyes.glb)."
)
EXAMPLE = "--iris 7:brown --format gltf --out scene"
FORMATS: Final = ("all", "files", "gltf")


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Add this command's arguments."""
    add_picture(parser)
    parser.add_argument(
        "--format",
        choices=FORMATS,
        default="all",
        help="files: meshes, textures, camera, light; gltf: eyes.glb alone (default: %(default)s)",
    )
    parser.add_argument(
        "--out",
        type=new_folder,
        default="out/scene",
        metavar="DIR",
        help="folder to write into (default: %(default)s)",
    )


def run(options: argparse.Namespace) -> int:
    """Write the files and print the paths of those to open first."""
    spec = spec_of(options)
    viewpoint = viewpoint_of(options, spec)

    from renderer.exchange.export import export_scene

    for path in export_scene(options.out, spec, what=options.format, **viewpoint):
        print(path)
    return 0
