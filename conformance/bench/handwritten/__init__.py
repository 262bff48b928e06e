"""A scene's function beside the same shader as one writes it by hand: time and error in one run."""
