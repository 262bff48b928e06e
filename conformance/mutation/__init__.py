"""The tester tested: planted faults in the oracle, the generator and the library, and a backend that lies.

`python -m conformance.mutation` runs every mutant and writes the table of README.md;
`python -m conformance.mutation --sampled` runs a fixed sample of each group, as the default tests do.
"""
