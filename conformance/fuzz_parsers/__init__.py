"""Fuzzing of everything that reads a file which a person hands over.

parsers.py    what is fuzzed: a reader, the files to start from
mutation.py   bytes to a file: damaged text, or a tree with other keys and values, so that it parses
sandbox.py    one run: only a sentence may come out, soon, and nothing is written elsewhere
documents.py  trees as TOML and JSON
__main__.py   `python -m conformance.fuzz_parsers NAME --runs N`, guided by coverage (atheris)

The default suite runs some of it with seeded bytes and without atheris; conformance/unit/test_fuzz_parsers.py
keeps findings as cases.
"""
