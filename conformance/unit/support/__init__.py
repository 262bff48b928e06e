"""What several unit tests share: small libraries, parsers of the emitted languages, random trees."""
