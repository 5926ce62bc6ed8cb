"""`python -m brdf_explorer` is the command `brdf-explorer`."""

from .cli import main

main(prog_name="brdf-explorer")
