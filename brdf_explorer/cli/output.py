"""What commands print and write: tables, progress, text files."""

import sys
from contextlib import contextmanager


def print_table(heads, rows, title=""):
    """A table on stdout, as wide as the terminal; a pipe gets the whole of it."""
    from rich.box import SIMPLE_HEAD
    from rich.console import Console
    from rich.table import Table
    from rich.text import Text

    console = Console(width=None if sys.stdout.isatty() else 200)
    styles = {"ok": "green", "broken": "bold red", "over": "bold red"}
    view = Table(*heads, box=SIMPLE_HEAD, pad_edge=False, show_edge=False)
    for row in rows:
        view.add_row(*(Text(cell, styles.get(cell, "")) for cell in row))
    if title:
        console.print(Text(title, "bold"), soft_wrap=True)
    console.print(view)
    console.print()


@contextmanager
def progress():
    """A function that shows a line of progress on a terminal's stderr, and nothing elsewhere."""
    from rich.console import Console
    from rich.text import Text

    console = Console(stderr=True)
    if not console.is_terminal:
        yield lambda text: None
        return
    with console.status("starting") as status:
        yield lambda text: status.update(Text(text))


def write_text(path, text):
    from ..state import replacing

    with replacing(path) as temporary:
        temporary.write_text(text, encoding="utf-8", newline="\n")
