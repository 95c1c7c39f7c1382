"""A local page that looks into the scene: a camera by mouse and keys, levels, counters."""
