"""What compiling an include with glslang costs: shader, empty shader, and what a second shader costs."""
