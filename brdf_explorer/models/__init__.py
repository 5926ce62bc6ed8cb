"""The models, one module each: a dataclass whose fields are the parameters. `MODELS` lists them by name."""

from .dielectric import Dielectric
from .diffuse import Diffuse
from .microfacet import Microfacet
from .multiscatter import Multiscatter
from .nonspecular import Nonspecular

MODELS = {model.name(): model for model in (Microfacet, Multiscatter, Nonspecular, Dielectric, Diffuse)}
