"""The mistakes a user can make, as one family of exceptions.

Whatever derives from ``DemoscopeError`` carries a message fit for a person: it names the thing, the
bad value and what is allowed. The command line prints it as one line and exits with status 2; the
window shows it and keeps its last good picture.
"""

from __future__ import annotations


class DemoscopeError(Exception):
    """Base of every error that is shown to the user without a traceback."""
