"""The lecture's integral over facets that are no mirrors ("Non-Specular Microfacets"), without f_mf's constant and without G.

    integral of D(wm) (wo . wm)+ (wi . wm)+ exp(kappa (wi . R(wm, wo) - wi . R(h, wo))) d wm,

a lobe of sharpness kappa about the facet's mirror direction R, with h the half vector, where the exponent is 0, its largest.
With kappa = 0 the facets are Lambertian. The exponent is -2 kappa (t^2 + c^2 a^2): t and a are wm's components along wo - wi
and along wo x wi, c is wo . h. So it is the same for wo and wi exchanged, and so are the nodes: the rule is reciprocal.

shaders/lib/facets.glsl says what the nodes are, and how large the error.
"""

import numpy as np

from .common import dot, length, normalize, quotient, split, vec
from .transcendental import atan2_precise, exp_precise

BLOCK = 1024
"""Pairs of directions at a time, whose nodes fit into a cache."""

PARALLEL = 1e-15
"""Length of a product of two directions below which these are one, and their plane is any."""
UPRIGHT = 1e-12
"""Squared length of wo - wi across h below which its direction is rounding."""
LEAST_DENSITY = 1e-30
"""Of D, under a logarithm."""
LEAST_SHARPNESS = 1e-3
"""Of twice kappa, under a fraction; below the least sharpness of a lobe."""
NARROW = 0.3
"""Of P over its value for a sharp lobe: where a wider cone ends rounding says, so nothing is cut."""


def facets(wo, wi, alpha, kappa, node_scale, nodes, D, gauss):
    """The integral (...) for wo and wi (..., 3).

    node_scale: of the slot facets; nodes: how many gauss gives; D and gauss: functions of the slots ndf and gauss.
    """
    shape = np.broadcast_shapes(wo.shape[:-1], wi.shape[:-1], np.shape(alpha)[:-1], np.shape(kappa))
    columns = [np.broadcast_to(x, (*shape, n)).reshape(-1, n) for x, n in ((wo, 3), (wi, 3), (alpha, 2))]
    kappa = np.broadcast_to(kappa, shape).ravel()
    out, rule = np.empty(len(kappa)), (nodes, gauss(np.arange(nodes)))
    for start in range(0, len(kappa), BLOCK):
        at = slice(start, start + BLOCK)
        with np.errstate(under="ignore"):  # in the tails of a density
            out[at] = _block(*(c[at] for c in columns), kappa[at], D, node_scale, *rule)
    return out.reshape(shape)


def _block(wo, wi, alpha, kappa, D, scale, n, gauss):
    stretch = np.concatenate([scale * alpha, np.ones((len(wo), 1))], axis=1)
    o, i, z = stretch * wo, stretch * wi, np.array([0.0, 0.0, 1.0])
    size_o, size_i = length(o), length(i)
    o, i = o / size_o[:, None], i / size_i[:, None]
    off_oi, off_o, off_i = dot(o - i, o - i), dot(o - z, o - z), dot(i - z, i - z)
    z_between, o_far = (off_oi > 1.0001 * np.maximum(off_o, off_i))[:, None], (off_o > off_i)[:, None]
    p = np.where(z_between | o_far, o, i)
    q = np.where(z_between, i, z)
    k = np.where(z_between, z, np.where(o_far, i, o))

    both_ways, t = wo + wi, wo - wi
    u_x = np.where(z_between, np.cross(t, both_ways), np.cross(np.where(o_far, wo, wi), z))
    side = np.where(dot(np.where(z_between, z, np.where(o_far, wi, wo)), u_x) < 0, -1.0, 1.0)[:, None]
    size = length(u_x)[:, None]
    u_x = side * np.where(size > PARALLEL, quotient(u_x, size), [1.0, 0.0, 0.0])
    size_corner = length(u_x / stretch)
    corner = u_x / stretch / size_corner[:, None]
    k_corner = np.maximum(dot(k, corner), 0.0)

    obtuse = dot(t, t) > dot(both_ways, both_ways)
    tilt = np.where(obtuse, quotient(dot(both_ways, t), dot(t, t)), 0.0)
    both_ways = both_ways - tilt[:, None] * t
    c = 0.5 * length(both_ways)
    h = both_ways / (2 * c)[:, None]
    turned = np.where(
        z_between & obtuse[:, None], t / np.sqrt(np.maximum(dot(t, t), 1.0))[:, None], side * np.cross(h, u_x)
    )
    t = t - dot(t, h)[:, None] * h
    other = np.where(np.abs(h[:, :1]) < 0.7, [1.0, 0.0, 0.0], [0.0, 1.0, 0.0])
    t = np.where(dot(t, t)[:, None] < UPRIGHT, other - dot(other, h)[:, None] * h, t)
    t = normalize(t)
    a = c[:, None] * np.cross(h, t)
    size_n = length(h / stretch)
    n_h = h / stretch / size_n[:, None]
    rise = dot(n_h, corner)
    reach = np.maximum(length(stretch * turned) / (stretch[:, 0] * stretch[:, 1] * size_n * size_corner), PARALLEL)
    across, u_y = normalize(stretch * turned), normalize(stretch * stretch * turned)

    ray_h = side * np.cross(corner, across)
    y_size = length(stretch * across)
    x_unit, y_unit = size_corner / size_n, 1 / (size_n * y_size)
    f_tx, f_ax, f_ty, f_ay = dot(t, u_x), dot(a, u_x), dot(t, u_y), dot(a, u_y)
    fall = np.log(D(z, alpha) / np.maximum(D(h, alpha), LEAST_DENSITY))
    level = 1 + 0.5 * n + np.minimum(2 * kappa * (t[:, 2] ** 2 + a[:, 2] ** 2), fall)
    rho = level / np.maximum(2 * kappa, LEAST_SHARPNESS)
    g_x, g_y = dot(u_x, h), dot(u_y, h)
    P = f_tx * f_tx + f_ax * f_ax - rho
    Q = f_tx * f_ty + f_ax * f_ay - rho * dot(u_x, u_y)
    S = f_ty * f_ty + f_ay * f_ay - rho
    cone = (kappa > 0) & (P > NARROW * (f_tx * f_tx + f_ax * f_ax))
    det = f_tx * f_ay - f_ax * f_ty
    mixed_t = f_tx[:, None] * u_y - f_ty[:, None] * u_x
    mixed_a = f_ax[:, None] * u_y - f_ay[:, None] * u_x
    normal = np.cross(u_x, u_y)
    A = rho * (dot(mixed_t, mixed_t) + dot(mixed_a, mixed_a)) - det * det - rho * rho * dot(normal, normal)
    B = rho * (P * g_y - Q * g_x)
    C = rho * (rho * g_x * g_x + P)
    o_h, i_h, z_h = c / (size_o * size_n), c / (size_i * size_n), h[:, 2] / size_n
    z_mid, o_mid = z_between[:, 0], o_far[:, 0]
    p_h = np.where(z_mid | o_mid, o_h, i_h)
    q_h = np.where(z_mid, i_h, z_h)
    k_h = np.where(z_mid, z_h, np.where(o_mid, i_h, o_h))
    p_across, q_across, k_across = dot(p, across), dot(q, across), dot(k, across)
    low, high = -atan2_precise(p_h, reach * p_across), atan2_precise(q_h, -reach * q_across)
    cut = cone & (B * B > A * C)
    both = np.sqrt(np.where(cut, B * B - A * C, 0.0)) + np.abs(B)
    near = np.where(cut, atan2_precise(C * y_unit, both * reach), np.pi)
    far = np.where(cut & (A < 0), atan2_precise(both * y_unit, -A * reach), np.pi)
    low = np.maximum(low, np.where(B > 0, -near, -far))
    high = np.minimum(high, np.where(B > 0, far, near))

    x, weight = split(gauss)
    P = np.where(cone, P, 1.0)
    total = np.zeros(len(wo))
    column = lambda v: v[:, None]  # noqa: E731
    for outer, share in zip(x, weight, strict=True):
        omega = 0.5 * (low + high) + 0.5 * (high - low) * outer
        bent, straight = np.sin(omega), np.cos(omega)
        ray = straight[:, None] * ray_h + bent[:, None] * across
        psi_k = atan2_precise(k_corner, -dot(k, ray))
        flat_p = np.maximum(straight / reach * p_h + bent * p_across, 0.0)
        flat_q = np.maximum(straight / reach * q_h + bent * q_across, 0.0)
        flat_k = straight / reach * k_h + bent * k_across
        rising = rise * straight
        psi_h, size_h = atan2_precise(reach, rising), np.hypot(reach, rising)
        first, last = -psi_h, psi_k - psi_h
        cut = cone & (straight > 0)
        y = reach * quotient(bent, np.where(cut, straight, 0.0)) / y_unit
        b = Q * y - rho * g_x
        both = np.sqrt(np.maximum((A * y + 2 * B) * y + C, 0.0)) + np.abs(b)
        near, far = quotient((S * y - 2 * rho * g_y) * y - rho, both), both / P
        x_high = straight * x_unit * np.where(b > 0, -near, far)
        x_low = straight * x_unit * np.where(b > 0, -far, near)
        high_edge = atan2_precise(-reach * x_high, size_h * size_h + rising * x_high)
        low_edge = atan2_precise(-reach * x_low, size_h * size_h + rising * x_low)
        first = np.where(cut, np.maximum(first, high_edge), first)
        last = np.where(cut, np.minimum(last, low_edge), last)
        last = np.maximum(last, first)

        step = column(0.5 * (first + last)) + column(0.5 * (last - first)) * x
        psi = column(psi_h) + step
        sine, cosine = np.sin(psi), np.cos(psi)
        past = np.sin(step) * column(size_h / reach)
        n_p, n_q = column(flat_p) * sine, column(flat_q) * sine
        n_k = np.maximum(column(flat_k) * sine - past * column(k_corner), 0.0)
        m_1, m_2 = (column(stretch[:, j]) * (cosine * column(corner[:, j]) + sine * column(ray[:, j])) for j in (0, 1))
        m_3 = np.where(z_between, n_k, n_q)
        both = n_p * np.where(z_between, n_q, n_k)
        m2 = m_1 * m_1 + m_2 * m_2 + m_3 * m_3
        off_t = sine * column(bent * y_size * f_ty) - past * column(f_tx / size_corner)
        off_a = sine * column(bent * y_size * f_ay) - past * column(f_ax / size_corner)
        lobe = exp_precise(-2 * column(kappa) * (off_t * off_t + off_a * off_a) / m2)
        density = D(vec(m_1, m_2, m_3), alpha[:, None, :])
        inner = density * lobe * both * sine / (m2 * m2 * np.sqrt(m2))
        total += share * 0.5 * (last - first) * (inner @ weight)
    return total * 0.5 * (high - low) * size_o * size_i * stretch[:, 0] * stretch[:, 1]
