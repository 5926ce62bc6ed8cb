"""What options take: sizes, numbers, angles, views; and those that several commands have."""

import re

import click

from .flags import number


class Size(click.ParamType):
    name = "WxH"

    def convert(self, value, param, ctx):
        if match := re.fullmatch(r"([0-9]{1,9})x([0-9]{1,9})", value, re.IGNORECASE):
            return int(match[1]), int(match[2])
        self.fail(f"{value!r} is not a size in pixels such as 512x512", param, ctx)


class Number(click.ParamType):
    """A float in a range; click's own takes NaN."""

    name = "N"

    def __init__(self, low, high):
        self.low = low
        self.high = high

    def convert(self, value, param, ctx):
        found = number(str(value))
        if found is None or not self.low <= found <= self.high:
            self.fail(f"{value} is not a number from {self.low:g} to {self.high:g}", param, ctx)
        return float(found)


class Angles(click.ParamType):
    name = "THETA,PHI"

    def convert(self, value, param, ctx):
        parts = [number(part) for part in value.split(",")]
        if len(parts) != 2 or None in parts:
            self.fail(f"{value!r} is not a direction in degrees such as 40,0", param, ctx)
        theta, phi = parts
        if not (0 <= theta <= 180 and -360 <= phi <= 360):
            self.fail(f"{value!r} is no direction: theta is 0 to 180 degrees, phi -360 to 360", param, ctx)
        return float(theta), float(phi)


class ViewName(click.ParamType):
    name = "VIEW"

    def convert(self, value, param, ctx):
        from ..model import nearest
        from ..views import VIEWS

        if value not in VIEWS:
            self.fail(f"{value!r} is no view{nearest(value, list(VIEWS))}", param, ctx)
        return value


preset_argument = click.argument("preset")
with_option = click.option(
    "--with", "others", metavar="PRESET", multiple=True, help="One more material, to compare with; may be repeated."
)
scene_option = click.option("--scene", metavar="PRESET", help="A preset under PRESET, for what PRESET does not hold.")
output_option = click.option("-o", "--output", required=True, metavar="FILE", help="The file to write.")
seconds_option = click.option("--time", "seconds", type=Number(0, 1e6), help="Most seconds to sample.")
