"""The procedural iris: from a seed and a colour family to albedo, relief and tissue layers."""
