"""``ocularist bench``: what a frame, an effect, a pixel, a start and a scene cost. Starts GL."""
