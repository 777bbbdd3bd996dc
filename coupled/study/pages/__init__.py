"""What a study writes: tables, pictures, and the text."""
