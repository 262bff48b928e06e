"""Fuzzing of everything that reads a file which a person hands over.

parsers.py    what is fuzzed: readers by name, made in descriptions.py, outcomes.py, measured.py, shapes.py,
              messages.py
parser.py     a reader and the files to start from
readers.py    the modules that read, followed by coverage, and a hash of them
mutation.py   bytes to a file: damaged text, or a tree with other keys and values, so that it parses
sandbox.py    one run: only a sentence may come out, soon, and nothing is written elsewhere
documents.py  trees as TOML and JSON; archives.py: as npz
__main__.py   `python -m conformance.fuzz_parsers NAME --runs N`, guided by coverage (atheris)
record.py     how much was run of each reader, and the table of README.md
campaign.py   goes on until each had a million files

The default suite runs some of it with seeded bytes and without atheris; conformance/unit/test_fuzz_parsers.py
keeps findings as cases.
"""
