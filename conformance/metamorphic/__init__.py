"""Pairs of programs or of inputs that must agree: relations, judged by the intervals of both sides."""
