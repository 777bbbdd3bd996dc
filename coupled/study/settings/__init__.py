"""What is run: knobs and their values, the settings made of them, what they cost, and the plan."""
