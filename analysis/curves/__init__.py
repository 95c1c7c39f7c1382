"""Psychometric curves: what people notice, prefer and rate along the size of the iris."""
