"""Generated parts of pages that are written by hand: what stands between two marks."""


def with_part(text: str, begin: str, end: str, part: str) -> str:
    """The text with another part between its marks; ValueError where a mark is missing."""
    first = text.index(begin) + len(begin)
    return text[:first] + part + text[text.index(end, first) :]
