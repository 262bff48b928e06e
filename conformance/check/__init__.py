"""Judging results: errors against references under declared bounds; every failure can be replayed."""
