"""Emission: IR to text. Dialects are data; printers keep the tree and decide nothing."""
