"""Measures and moving pictures of runs, from their files alone."""
