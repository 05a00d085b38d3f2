"""What goes wrong with a study, in plain English: studies are run from the command line only."""

from __future__ import annotations


class StudyError(Exception):
    """Settings, files or helpers that a study cannot work with; the message says how to mend it."""
