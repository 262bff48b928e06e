"""Plates of bodies lit by environment maps, each in all the ways that the library has."""
