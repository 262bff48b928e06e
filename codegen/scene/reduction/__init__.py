"""From a scene's general function to the cheapest one within its budget."""
