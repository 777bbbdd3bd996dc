"""What speed costs in accuracy: a scene over its knobs, measured against its finest setting or a closed form."""
