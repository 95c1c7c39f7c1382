"""The eye: anatomy and optics in numbers, meshes, maps, light inside it, and what draws it."""
