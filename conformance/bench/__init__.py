"""Speed beside error: variants of one function interleaved on one driver, and the figures that are promised.

`run.measure` gives what `vair report` shows. README.md says how it is measured.
"""
