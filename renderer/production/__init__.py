"""Clips made: one, a folder of them, on one machine or many."""
