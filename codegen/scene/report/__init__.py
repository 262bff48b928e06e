"""What is written of a scene: the file of each target and the report."""
