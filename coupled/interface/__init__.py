"""The door between grains and structure: glued grains or facets behind one protocol."""
