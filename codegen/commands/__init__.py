"""Subcommands that need no device but the doctor's."""
