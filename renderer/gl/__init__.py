"""OpenGL itself: what every drawing module rests on, and none of it knows what is drawn."""
