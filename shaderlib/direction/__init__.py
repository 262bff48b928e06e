"""Directions: components along a line, angles between unit vectors, frames."""
