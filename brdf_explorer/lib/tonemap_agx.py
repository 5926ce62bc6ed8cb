"""Slot tonemap: AgX by Troy Sobotka, its default look, the curve as the polynomial of Benjamin Wrensch (2023).

Its result is encoded with gamma 2.2 and is made linear again here.
"""

import numpy as np

INPUT = np.array(
    [
        [0.842479062253094, 0.0784335999999992, 0.0792237451477643],
        [0.0423282422610123, 0.878468636469772, 0.0791661274605434],
        [0.0423756549057051, 0.0784336, 0.879142973793104],
    ]
)
OUTPUT = np.array(
    [
        [1.19687900512017, -0.0980208811401368, -0.0990297440797205],
        [-0.0528968517574562, 1.15190312990417, -0.0989611768448433],
        [-0.0529716355144438, -0.0980434501171241, 1.15107367264116],
    ]
)
CURVE = (15.5, -40.14, 31.96, -6.868, 0.4298, 0.1191, -0.00232)


def tonemap(color):
    v = np.asarray(color) @ INPUT.T
    x = (np.clip(np.log2(np.maximum(v, 1e-10)), -12.47393, 4.026069) + 12.47393) / (4.026069 + 12.47393)
    return np.maximum(np.polyval(CURVE, x) @ OUTPUT.T, 0.0) ** 2.2
