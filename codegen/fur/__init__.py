"""Fur on a mesh: what a host has to prepare and to draw, and the text of the stages that draw it."""
