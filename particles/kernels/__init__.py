"""Compiled inner loops on plain arrays. Nothing here knows a class, a unit or a file."""
