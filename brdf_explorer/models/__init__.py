"""The models, one module each: a dataclass whose fields are the parameters. `MODELS` lists them by name."""

from .diffuse import Diffuse
from .microfacet import Microfacet
from .nonspecular import Nonspecular

MODELS = {model.name(): model for model in (Microfacet, Diffuse, Nonspecular)}
