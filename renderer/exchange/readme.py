"""README.txt of an exported scene: how to read its files."""

from __future__ import annotations

from typing import Final

README: Final = """\
A scene of Ocularist
====================

scene.json names every file here, with its unit, space, encoding and material.

Space     millimetres, right-handed: x to the viewer's right, y up, z from the face to the viewer.
          The origin lies midway between the centres of the two globes. "left" and "right" are the
          viewer's, as seen on the screen. For metres multiply by 0.001; Blender: import the PLY
          files with forward -Z and up Y, scale 0.001.
Meshes    meshes/*.ply, binary, counter-clockwise seen from outside, unit normals per vertex.
          s t are texture coordinates with t upwards. r g b are linear Rec. 709 reflectances,
          red green blue the same as sRGB bytes.
Eyes      cornea and sclera are one surface, cut at the limbus, with the same vertices there. The
          renderer itself fades from one to the other over about a millimetre. iris is the flat
          disc with the hole of the pupil and the wall up to the limbus; iris_relief is the same
          with its height field: take one of the two. The disc behind the pupil has the black of
          the map's middle.
Optics    one smooth interface, air 1.0 outside, 1.336 inside. Some path tracers take 1.000277 for
          air unless told. Light from a point or a direction through a smooth interface is seen by
          photon or light tracing only; textures/caustic_*.exr has it solved: multiply its
          irradiance by that of the sun, and leave the cosine out, which it contains.
Textures  the first row is the top, t = 1. PNG: sRGB where scene.json says so, else linear data
          (load it as "non-colour" or "raw"). EXR: linear. The maps were made for the left eye; the
          right eye has mirrored texture coordinates, not mirrored pictures.
Camera    camera.json: one view per eye at macroscopic distance, side by side, else one view.
          world_to_camera and projection multiply column vectors; the camera looks along -z, y up.
          Mitsuba: fov_axis "y", to_world = camera_to_world with its x and z columns negated.
Light     environment.exr is radiance from everywhere but the sun, latitude-longitude: the first row
          looks up, the middle column along +z, the left half towards +x. Mitsuba's envmap reads it
          as it is. The sun is a directional light: scene.json, sun.
Colour    linear, scene-referred, Rec. 709 primaries, D65. White that faces the sun has radiance of
          about 1. The renderer's picture: times exposure, then its tone curve.
"""
