"""Illuminated strands: Kajiya-Kay, Banks and Scheuermann shading, and light on its way through a coat."""
