"""A copy of a page or text for the repository."""


def make(page: str) -> str:
    """The page itself."""
    return page
