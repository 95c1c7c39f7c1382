"""What all procedural textures share: noise, fibres, sizes, tiling."""
