"""The documentation as pages: one for each function with what is recorded of it, and the guides."""
