"""What makes a selection of functions ready to print."""
