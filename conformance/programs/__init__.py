"""Programs made for tests: added functions, many functions in one program, verdicts by interval."""
