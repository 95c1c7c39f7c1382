"""The surroundings: sky, sun, horizon, their cube maps and the background."""
