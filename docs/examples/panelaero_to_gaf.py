"""Doublet-lattice forces of a wing as a file that fladder reads (`[gaf] file`).

Needs numpy and PanelAero (pip install PanelAero). The wing: rectangular, chord 1 m, span 8 m,
no thickness; x aft from the leading edge, y to starboard, z up. Put your own panels into
`panels`, your own modes into `MODES`: a mode is its upward displacement z(x, y) in metres
for a coordinate of 1 and its slope dz/dx.

Signs: motion exp(+i omega t), force q * Q * xi on the structure, row force, column motion;
k = omega b / U with the SEMIchord b. PanelAero's k is omega / U.
"""
import json
import sys

import numpy as np
from panelaero import DLM

CHORD, SPAN, SEMICHORD = 1.0, 8.0, 0.5
CHORDWISE, SPANWISE = 8, 48
# Close together near 0, where forces change most.
K = [round(1.2 * (i / 20) ** 1.5, 6) for i in range(21)]
TIP = SPAN / 2
MIDDLE = CHORD / 2
MODES = {
    "plunge": (lambda x, y: np.ones_like(x), lambda x, y: np.zeros_like(x)),
    # Nose up about mid-chord: what is aft goes down.
    "pitch": (lambda x, y: -(x - MIDDLE), lambda x, y: -np.ones_like(x)),
    "bending": (lambda x, y: (y / TIP) ** 2, lambda x, y: np.zeros_like(x)),
    "torsion": (lambda x, y: -(x - MIDDLE) * (y / TIP) ** 2, lambda x, y: -((y / TIP) ** 2)),
}


def panels():
    """A flat wing as PanelAero wants it: one row a box."""
    x = np.linspace(0.0, CHORD, CHORDWISE + 1)
    y = np.linspace(-TIP, TIP, SPANWISE + 1)
    left, front = np.meshgrid(y[:-1], x[:-1])
    left, front = left.ravel(), front.ravel()
    width, length = y[1] - y[0], x[1] - x[0]
    flat = np.zeros_like(left)
    point = lambda along, across: np.column_stack([front + along * length, left + across * width, flat])
    return {
        "n": len(left),
        "A": np.full(len(left), width * length),
        "l": np.full(len(left), length),
        "N": np.tile([0.0, 0.0, 1.0], (len(left), 1)),
        "offset_j": point(0.75, 0.5),  # where the flow is tangential
        "offset_l": point(0.25, 0.5),  # where the force acts
        "offset_P1": point(0.25, 0.0),  # ends of the bound vortex
        "offset_P3": point(0.25, 1.0),
    }


def forces(grid, mach):
    """Q of all k: points x modes x modes."""
    receive, load = grid["offset_j"], grid["offset_l"]
    lift = np.array([z(load[:, 0], load[:, 1]) for z, _ in MODES.values()]) * grid["A"]
    shapes = [(z(receive[:, 0], receive[:, 1]), slope(receive[:, 0], receive[:, 1])) for z, slope in MODES.values()]
    q = []
    for k in K:
        # Normal velocity of the surface over U, downwards: what the wing meets as upwash.
        wash = np.array([-(slope + 1j * k / SEMICHORD * z) for z, slope in shapes]).T
        pressure = DLM.calc_Qjj(grid, mach, k / SEMICHORD) @ wash
        q.append(lift @ pressure)
    return np.array(q)


def document(q, mach):
    """The neutral file."""
    entry = lambda value: [float(value.real), float(value.imag)]
    return {
        "schema": "fladder.gaf/1",
        "mach": mach,
        "semichord": SEMICHORD,
        "modes": list(MODES),
        "frames": ["inertial"] * len(MODES),
        "steady": [0.0] * len(MODES),
        "points": [
            {"g": 0.0, "k": k, "q": [[entry(v) for v in row] for row in matrix]} for k, matrix in zip(K, q)
        ],
    }


if __name__ == "__main__":
    mach = float(sys.argv[2]) if len(sys.argv) > 2 else 0.0
    result = document(forces(panels(), mach), mach)
    with open(sys.argv[1] if len(sys.argv) > 1 else "q.json", "w") as file:
        json.dump(result, file, indent=1)
        file.write("\n")
