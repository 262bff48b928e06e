"""Strands of hair: their scene made ready, drawn as ribbons by rasterisers and by rays."""
