"""A run: its loop, what it looks at, what stops it, and how it goes on."""
