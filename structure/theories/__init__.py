"""Theories of strain, each with the step in time that fits it: linear, corotational, large strain."""
