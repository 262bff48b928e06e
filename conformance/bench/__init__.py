"""Speed beside error: variants of one function interleaved on one driver, and the figures that are promised.

`./dev bench` prints the tables; `run.measure` gives the same as data. README.md says how it is measured.
"""
