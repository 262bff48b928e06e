"""The time of a frame of fur: Vair's stages beside hand-written ones, a scene's beside general ones."""
