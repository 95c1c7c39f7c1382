"""Descriptive statistics: means, shares and what the data is worth, before any model."""
