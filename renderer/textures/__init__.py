"""What procedural textures and shapes share: noise, fibres, sizes, tiling, the smooth step."""
