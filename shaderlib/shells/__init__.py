"""Shells and fins: fur as a stack of blended layers, with fins on the silhouette."""
