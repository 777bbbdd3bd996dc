"""Bodies without strain: along a prescribed path, or free."""
