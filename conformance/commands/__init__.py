"""Subcommands that run on devices; the command line loads them by name."""
