"""A scene over seeds and a grid of keys: its samples, and what they have in the mean."""
