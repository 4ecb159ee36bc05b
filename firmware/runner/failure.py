"""What the user is told: that something failed, or what is being done."""

import sys


class Failure(Exception):
    """One line for the user."""


def note(text):
    """What is done besides the image's own output."""
    print(text, file=sys.stderr, flush=True)
