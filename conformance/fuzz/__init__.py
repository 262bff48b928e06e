"""Random programs in the source subset, through the front end to every target, judged by interval."""
