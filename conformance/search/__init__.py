"""Searching for the inputs on which a function errs most: a hill-climb in the space of float32 words.

What it finds is a lower bound of the worst error, never a bound; sweeps give those (conformance.sweep).
The finds are kept in conformance/cases/worst and checked in every run as the family "worst".
"""
