"""A coat of fur: its scene made ready, drawn as shells and fins by rasterisers and by rays."""
