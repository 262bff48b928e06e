"""Scene files as data: what is shaded, by which lights, and what is known of it."""
