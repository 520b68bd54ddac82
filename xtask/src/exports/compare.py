"""Reads what `fladder run` wrote with NumPy and pyNastran and holds it against the JSON."""
import json
import sys

import numpy as np
from pyNastran.f06.parse_flutter import make_flutter_response
from pyNastran.op4.op4 import read_op4

folder = sys.argv[1]
with open(folder + "/gaf.json") as file:
    forces = json.load(file)
with open(folder + "/flutter.json") as file:
    methods = json.load(file)["methods"]
best = methods.get("polished") or methods.get("p2") or methods["pk"]
q = np.array([[[complex(*entry) for entry in row] for row in p["q"]] for p in forces["points"]])
failures = 0


def check(name, error, limit):
    """Prints a difference and counts it where it is too large."""
    global failures
    print(f"{name}: {error:.1e} (at most {limit:.0e})")
    failures += not error <= limit


archive = np.load(folder + "/gaf.npz")
check("gaf.npz against gaf.json", abs(archive["q"] - q).max(), 0.0)
names = [name.decode() for name in archive["modes"]]
check("names of modes", float(names != forces["modes"]), 0.0)

matrices = read_op4(folder + "/gaf.op4", debug=False)
data = [getattr(matrices[f"Q{i + 1}"], "data", None) for i in range(len(q))]
data = [m if m is not None else matrices[f"Q{i + 1}"][1] for i, m in enumerate(data)]
check("gaf.op4 against gaf.json", max(abs(m - p).max() for m, p in zip(data, q)), 0.0)

models = np.load(folder + "/state_space.npz")
worst = 0.0
for speed, matrix in zip(models["speed"], models["A"]):
    found = np.linalg.eigvals(matrix)
    for branch in best["branches"]:
        for i, at in enumerate(branch["speed"]):
            if abs(at - speed) < 1e-9 and abs(branch["g"][i]) < 0.05 and branch["k"][i] > 0.05:
                root = complex(branch["sigma"][i], branch["omega"][i])
                worst = max(worst, abs(found - root).min() / abs(root))
check("eigenvalues of state_space.npz against roots near the axis", worst, 1e-4)

response = make_flutter_response(folder + "/flutter_summary.f06", f06_units="si", out_units="si")[1]
worst = 0.0
for number, branch in enumerate(best["branches"]):
    lines = response.results[number]
    for i, speed in enumerate(branch["speed"]):
        line = min(lines, key=lambda row: abs(row[response.ivelocity] - speed))
        for column, values in ((response.ifreq, "frequency_hz"), (response.idamping, "structural_damping")):
            if branch[values][i] is not None:
                worst = max(worst, abs(line[column] - branch[values][i]) / (1 + abs(branch[values][i])))
check("flutter_summary.f06 by pyNastran against flutter.json", worst, 1e-6)
sys.exit(1 if failures else 0)
