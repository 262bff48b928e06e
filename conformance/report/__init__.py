"""Speed against error as a report: data, fronts, the page and the picture of the overview.

`vair report` measures with conformance.bench and writes what is here; README.md describes the data.
"""
