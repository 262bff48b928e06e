"""Maps for tests of lookups, and how near drivers come to float32 filter weights."""
