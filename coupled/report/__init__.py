"""What is told of a scene and of a run: check, cautions, summary, figures."""
