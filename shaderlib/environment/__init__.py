"""Light from environment maps: lookups, and estimators of what a lobe reflects of it."""
