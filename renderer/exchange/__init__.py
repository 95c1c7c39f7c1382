"""Pictures, meshes and scenes in open formats, for other programs and from them."""
