"""Functions of two arguments as textures, with axes and sizes chosen from an error budget."""
