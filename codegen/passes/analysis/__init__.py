"""What is known of values: ranges, lengths, operations."""
