"""Factored reflectances: how well they fit, what they cost and err beside direct functions."""
