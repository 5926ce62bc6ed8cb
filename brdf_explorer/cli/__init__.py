"""The command line: its commands, and how it ends.

Only click is imported here at first; all else is imported inside the command that needs it, so that none waits for another.
"""

import os
import sys

import click

from .. import __version__
from .draw import gallery, open_, render
from .ladders import chart, least
from .numbers import check, eval_, table
from .program import bench, models, presets
from .stability import stability

BAD_INPUT = 2


class Group(click.Group):
    """The commands; a first argument that is none of them is a preset to open. Errors are one line and an exit status."""

    def main(self, args=None, prog_name="brdf-explorer", standalone_mode=True, **extra):
        if not standalone_mode:
            return super().main(args, prog_name, standalone_mode=False, **extra)
        sys.stdout.reconfigure(errors="backslashreplace")  # on Windows a pipe knows few letters
        try:
            status = super().main(args, prog_name, standalone_mode=False, **extra) or 0
            sys.stdout.flush()
        except click.ClickException as error:
            status = complain(error.format_message())
        except (click.Abort, KeyboardInterrupt):
            status = 130
        except OSError as error:  # of stdout; other files are Invalid when they fail
            os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())
            # a reader that had enough, such as `head`, is no error
            status = (
                141
                if isinstance(error, BrokenPipeError)
                else complain(f"{error.filename or 'output'}: {error.strerror}")
            )
        except ValueError as error:
            from ..model import Invalid

            if not isinstance(error, Invalid):
                raise
            status = complain(str(error))
        sys.exit(status)

    def parse_args(self, ctx, args):
        own = {*self.commands, *(name for option in self.get_params(ctx) for name in option.opts)}
        return super().parse_args(ctx, args if args and args[0] in own else ["open", *args])


def complain(message):
    """Say what is wrong, on one line."""
    click.echo(f"brdf-explorer: {' '.join(message.split())}", err=True)
    return BAD_INPUT


@click.group(cls=Group, context_settings={"help_option_names": ["-h", "--help"], "max_content_width": 120})
@click.version_option(__version__, prog_name="brdf-explorer", message="%(prog)s %(version)s")
def main():
    """Explore reflection models.

    With no COMMAND, `brdf-explorer [PRESET]` opens the window. A PRESET is a name that the command `presets` lists, the name
    of a model, or the path of a preset file or of a picture or table that carries one. Its parameters are flags: `render
    PRESET --help` lists them.
    """


for command in (open_, render, gallery, eval_, table, check, chart, least, stability, models, presets, bench):
    main.add_command(command)
