"""Environment maps on the host: reading, resampling to paraboloids and octahedra, chains, prefiltering."""
