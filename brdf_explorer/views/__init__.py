"""The views, one module each. `VIEWS` lists them by name."""

from .chart import Chart
from .compare import Compare
from .factors import Factors
from .hemisphere import Hemisphere
from .least import Least
from .lobe import Lobe
from .microsurface import Microsurface
from .polar import Polar
from .sampling import Sampling
from .sphere import Sphere
from .stability import Stability

VIEWS = {
    view.name(): view
    for view in (Sphere, Lobe, Polar, Factors, Hemisphere, Sampling, Compare, Chart, Stability, Least, Microsurface)
}
