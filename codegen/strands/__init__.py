"""Strands of hair as ribbons: what a host prepares and draws, and the text of the stages."""
