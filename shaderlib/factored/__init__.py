"""Reflectances as products of textures, and functions of two angles as tables."""
