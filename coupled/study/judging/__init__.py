"""What settings are worth: references, errors against them, and the front."""
