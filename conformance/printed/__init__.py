"""What each misprint of the lecture does: the printed and the right form side by side, measured and drawn."""
