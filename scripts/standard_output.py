"""What scripts write to standard output, help included: all of it, or an error that says why not."""

from __future__ import annotations

import argparse
import os
import sys
from typing import TextIO

# What a shell reports for a program that a closed pipe has ended.
CLOSED_PIPE = 128 + 13


def tell(text: str) -> None:
    """Print a text; a reader that has closed the pipe ends the script quietly."""
    try:
        print(text, flush=True)
    except OSError as error:
        # What is left in the buffer must not be written again at the end.
        os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())
        if isinstance(error, BrokenPipeError):
            sys.exit(CLOSED_PIPE)
        sys.exit(f"cannot write to standard output: {error}")


class Parser(argparse.ArgumentParser):
    """A parser whose help is written or is an error, as everything else is."""

    def print_help(self, file: TextIO | None = None) -> None:
        if file is None:
            tell(self.format_help().rstrip("\n"))
        else:
            super().print_help(file)
