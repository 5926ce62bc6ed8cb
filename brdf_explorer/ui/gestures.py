"""What a drag or the wheel on a picture does to the state, by the view's name. Positions in pixels of the picture."""

import math
from dataclasses import replace

from ..model import declared
from ..views.compare import side_of

DRAGGED = ("sphere", "lobe", "polar", "compare", "microsurface")  # views that a drag changes
ORBIT = 0.4  # degrees that a point of drag turns a camera or an environment


def linked(links, at):
    """The last of the links that are under the mouse, or None."""
    x, y = at
    return next((k for k in reversed(links) if k.box[0] <= x <= k.box[2] and k.box[1] <= y <= k.box[3]), None)


def light(state, view, at, size):
    """The directional light under the mouse: 90 degrees on the sphere's rim, 180 at twice its radius."""
    x, y = at[0] - size[0] / 2, size[1] / 2 - at[1]
    theta = min(90 * math.hypot(x, y) / view.radius(size), 180)
    phi = math.degrees(math.atan2(y, x))
    return replace(state, light=replace(state.light, theta=round(theta, 1), phi=round(phi, 1)))


def turn(state, delta, scale):
    """The environment turned by a drag, where there is no directional light to move."""
    rotation = (state.light.rotation - ORBIT * delta[0] / scale + 180) % 360 - 180
    return replace(state, light=replace(state.light, rotation=round(rotation, 1)))


def light_position(state, view, size):
    """Where `light` would put the light of the state."""
    reach = state.light.theta / 90 * view.radius(size)
    phi = math.radians(state.light.phi)
    return size[0] / 2 + reach * math.cos(phi), size[1] / 2 - reach * math.sin(phi)


def orbit(state, view, delta, scale):
    """The lobe's camera turned by a drag."""
    azimuth = (view.azimuth - ORBIT * delta[0] / scale + 180) % 360 - 180
    limits = declared(view)["elevation"]
    elevation = min(max(view.elevation + ORBIT * delta[1] / scale, limits.low), limits.high)
    return state.with_view("lobe", azimuth=round(azimuth, 1), elevation=round(elevation, 1))


def zoom(state, view, wheel):
    """The lobe's size after some notches of the wheel."""
    limits = declared(view)["zoom"]
    return state.with_view("lobe", zoom=min(max(round(view.zoom * 1.1**wheel, 3), limits.low), limits.high))


def viewer(state, view, at, size, scale):
    """The viewer's polar angle under the mouse."""
    left, foot = view.pivot(state, size, scale)
    x, y = at[0] - left, size[1] - foot - at[1]
    theta = math.degrees(math.atan2(x, max(y, 0.0)))
    limits = declared(state.directions)["theta_o"]
    theta = min(max(round(theta, 1), limits.low), limits.high)
    return replace(state, directions=replace(state.directions, theta_o=theta))


def swipe(state, view, at, size, scale):
    """The line between the spheres of `compare` under the mouse."""
    boxes, *_ = view.boxes(size, scale)
    if "sphere" not in boxes:
        return state
    left, _, right, _ = boxes["sphere"]
    share = 0.5 + (at[0] - (left + right) / 2) / side_of(boxes)
    return state.with_view("compare", swipe=round(min(max(share, 0.0), 1.0), 3))
