"""Judging results: errors against references under declared bounds, reported so that a failure can be replayed."""
