"""Where values are computed: regions, names, order, and what is dead."""
