"""Frames to video, and what the video keeps of them."""
