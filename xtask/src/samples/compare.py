"""Figures read by fladder against those of independent readers, node by node.

Takes the JSON lines that `cargo xtask samples` writes. Bulk data, .op2 and .op4
files are read by pyNastran, universal files by pyuff; printed files, for which
there is no other reader of eigenvectors, by splitting their lines here.
Exits with 1 when a file is not read or a figure differs.
"""

import json
import sys
import warnings

import numpy as np

warnings.filterwarnings("ignore")

# Relative to the largest value of a table: text has at least six digits, and
# everything else must agree to rounding.
TOLERANCE = 1e-12


class Differs(Exception):
    pass


def worst(name, ours, theirs):
    """Largest difference relative to the largest value."""
    ours, theirs = np.asarray(ours), np.asarray(theirs)
    if ours.shape != theirs.shape:
        raise Differs(f"{name}: {ours.shape} here, {theirs.shape} there")
    if ours.size == 0:
        return 0.0
    scale = np.abs(theirs).max()
    error = np.abs(ours - theirs).max()
    relative = error / scale if scale else error
    if not relative <= TOLERANCE:
        raise Differs(f"{name} differs by {relative:.1e} of the largest value")
    return relative


def same(name, ours, theirs):
    if list(ours) != list(theirs):
        raise Differs(f"{name}: {len(ours)} here, {len(theirs)} there, not the same")


def shapes(contents, index):
    mode = contents["modes"][index]
    displacement = np.array(mode["displacement"])
    if mode["rotation"] is None:
        return displacement
    return np.hstack([displacement, np.array(mode["rotation"])])


def join(model):
    """Nodes and coordinate systems alone: properties may be missing."""
    model._cross_reference_coordinates()
    model._cross_reference_nodes()


def nodes_of(model):
    ids = sorted(model.nodes)
    return ids, np.array([model.nodes[n].get_position() for n in ids])


KINDS = {
    "CTRIA3": 3, "CTRIAR": 3, "CTRIA6": 6, "CQUAD4": 4, "CQUADR": 4, "CQUAD8": 8,
    "CSHEAR": 4, "CBAR": 2, "CBEAM": 2, "CROD": 2, "CTUBE": 2, "CONROD": 2,
    "CTETRA": 10, "CPENTA": 15, "CHEXA": 20,
}


def model(contents, other):
    """Nodes and elements of a pyNastran model."""
    ids, places = nodes_of(other)
    same("node numbers", [node[0] for node in contents["nodes"]], ids)
    error = worst("node positions", [node[1] for node in contents["nodes"]], places)
    theirs = {
        number: [n for n in element.node_ids if n is not None]
        for number, element in other.elements.items()
        if element.type in KINDS
    }
    ours = {number: nodes for number, _, nodes in contents["elements"]}
    rigid = {number for number, element in other.rigid_elements.items() if element.type == "RBAR"}
    ours = {number: nodes for number, nodes in ours.items() if number not in rigid}
    same("element numbers", sorted(ours), sorted(theirs))
    for number, nodes in theirs.items():
        same(f"nodes of element {number}", sorted(ours[number]), sorted(nodes))
    return f"{len(ids)} nodes, {len(theirs)} elements", error


def bulk(path, contents):
    from pyNastran.bdf.bdf import BDF

    other = BDF(debug=None)
    other.read_bdf(path, xref=False, punch=False)
    join(other)
    return model(contents, other)


def op2(path, contents):
    from pyNastran.op2.op2_geom import OP2Geom

    other = OP2Geom(debug=None)
    other.read_op2(path, combine=True)
    found, errors = [], [0.0]
    if other.nodes:
        join(other)
        text, error = model(contents, other)
        found.append(text)
        errors.append(error)
    for table in other.eigenvectors.values():
        same("nodes of modes", contents["mode_nodes"], table.node_gridtype[:, 0].tolist())
        same("modes", [mode["index"] for mode in contents["modes"]], list(table.modes))
        for k in range(len(table.modes)):
            errors.append(worst(f"mode {k + 1}", shapes(contents, k), table.data[k]))
        found.append(f"{len(table.modes)} modes at {len(contents['mode_nodes'])} nodes")
    for table in other.eigenvalues.values():
        if not hasattr(table, "generalized_mass"):
            continue
        masses = [mode["generalised_mass"] for mode in contents["modes"]]
        errors.append(worst("masses", masses, table.generalized_mass))
        frequencies = [mode["frequency_hz"] for mode in contents["modes"]]
        errors.append(worst("frequencies", frequencies, table.cycles))
    return ", ".join(found) or "no geometry and no modes in either", max(errors)


def op4(path, contents):
    from pyNastran.op4.op4 import OP4

    other = OP4(debug=False).read_op4(path)
    theirs = {}
    for name, matrix in other.items():
        for one in matrix if isinstance(matrix, list) else [matrix]:
            data = one[1] if isinstance(one, tuple) else one.data
            if isinstance(data, list):
                theirs[name] = list(data)
            else:
                theirs.setdefault(name, []).append(data)
    ours = {}
    for matrix in contents["matrices"]:
        dense = np.zeros((matrix["rows"], matrix["columns"]), dtype=complex)
        for row, column, (real, imaginary) in matrix["entries"]:
            dense[row, column] = complex(real, imaginary)
        ours.setdefault(matrix["name"], []).append(dense)
    same("matrix names", sorted(ours), sorted(theirs))
    errors, count = [0.0], 0
    for name, matrices in theirs.items():
        if len(matrices) != len(ours[name]):
            raise Differs(f"{name}: {len(ours[name])} matrices here, {len(matrices)} there")
        for mine, other_one in zip(ours[name], matrices):
            dense = other_one.toarray() if hasattr(other_one, "toarray") else np.asarray(other_one)
            errors.append(worst(name, mine, dense))
            count += 1
    return f"{count} matrices", max(errors)


def unv(path, contents):
    import pyuff

    sets = pyuff.UFF(path).read_sets()
    sets = sets if isinstance(sets, list) else [sets]
    found, errors, modes = [], [0.0], 0
    for data in sets:
        if data["type"] in (15, 2411):
            mine = {number: place for number, place in contents["nodes"]}
            numbers = [int(n) for n in data["node_nums"]]
            same("node numbers", sorted(mine), sorted(numbers))
            places = np.column_stack([data["x"], data["y"], data["z"]])
            errors.append(worst("node positions", [mine[n] for n in numbers], places))
            found.append(f"{len(numbers)} nodes")
        elif data["type"] == 2412:
            theirs = {}
            for group in data.values():
                if isinstance(group, list):
                    for element in group:
                        theirs[int(element["element_nums"])] = element["nodes_nums"]
                elif isinstance(group, dict) and "element_nums" in group:
                    for number, nodes in zip(group["element_nums"], group["nodes_nums"]):
                        theirs[int(number)] = nodes
            mine = {number: nodes for number, _, nodes in contents["elements"]}
            same("element numbers", sorted(mine), sorted(theirs))
            for number, nodes in theirs.items():
                same(f"element {number}", sorted(mine[number]), sorted(int(n) for n in nodes))
            found.append(f"{len(theirs)} elements")
        elif data["type"] == 55:
            numbers = [int(n) for n in data["node_nums"]]
            same("nodes of modes", contents["mode_nodes"], numbers)
            names = ["r1", "r2", "r3", "r4", "r5", "r6"]
            columns = [np.real(data[name]) for name in names if name in data]
            values = np.column_stack(columns[: shapes(contents, modes).shape[1]])
            errors.append(worst("mode", shapes(contents, modes), values))
            frequency = contents["modes"][modes]["frequency_hz"]
            errors.append(worst("frequency", [frequency], [data["freq"]]))
            modes += 1
            found.append(f"a mode at {len(numbers)} nodes")
    return ", ".join(found), max(errors)


def f06(path, contents):
    """Split lines: a node is a number, G and six reals."""
    rows, tables, current, in_rows = [], [], None, False
    with open(path, encoding="latin-1") as file:
        for line in file:
            packed = line.replace(" ", "").strip()
            words = line.split()
            if packed.endswith("REALEIGENVALUES"):
                in_rows = True
            elif "REALEIGENVECTORNO." in packed:
                number = int(packed.rsplit(".", 1)[1])
                if not tables or tables[-1][0] != number:
                    tables.append((number, []))
                current, in_rows = tables[-1][1], False
            elif line.startswith("1"):
                current, in_rows = None, False
            elif in_rows and len(words) == 7 and words[0].isdigit():
                rows.append([int(words[0])] + [float(word) for word in words[2:]])
            elif current is not None and len(words) == 8 and words[1] == "G":
                current.append([int(words[0])] + [float(word) for word in words[2:]])
    mine = [
        [r["mode"], r["lambda"], r["frequency_hz"], r["generalised_mass"], r["generalised_stiffness"]]
        for r in contents["eigenvalues"]
    ]
    theirs = [[row[0], row[1], row[3], row[4], row[5]] for row in rows]
    if len(mine) != len(theirs):
        raise Differs(f"{len(mine)} eigenvalues here, {len(theirs)} there")
    errors = [worst("eigenvalues", mine, theirs)] if rows else [0.0]
    same("modes", [mode["index"] for mode in contents["modes"]], [table[0] for table in tables])
    for k, (number, table) in enumerate(tables):
        same("nodes of modes", contents["mode_nodes"], [row[0] for row in table])
        errors.append(worst(f"mode {number}", shapes(contents, k), [row[1:] for row in table]))
    found = f"{len(rows)} eigenvalues, {len(tables)} modes at {len(contents['mode_nodes'])} nodes"
    return found, max(errors)


READERS = {
    "nastran-bulk": ("pyNastran", bulk),
    "nastran-op2": ("pyNastran", op2),
    "nastran-op4": ("pyNastran", op4),
    "nastran-f06": ("lines split", f06),
    "unv": ("pyuff", unv),
}


def main():
    failed = 0
    with open(sys.argv[1]) as lines:
        for line in lines:
            entry = json.loads(line)
            path, contents = entry["path"], entry["contents"]
            name = "/".join(path.split("/")[-2:])
            if contents is None:
                print(f"NOT READ  {name}: {entry['error']}")
                failed += 1
                continue
            reader, compare = READERS.get(contents["format"], (None, None))
            if compare is None:
                print(f"ALONE     {name}: {contents['format']} has no other reader here")
                failed += 1
                continue
            try:
                found, error = compare(path, contents)
            except Differs as difference:
                print(f"DIFFERS   {name}: {difference}")
                failed += 1
                continue
            except Exception as fault:
                print(f"UNREAD    {name}: {reader} fails: {type(fault).__name__}: {fault}")
                failed += 1
                continue
            print(f"agrees    {name}: {contents['format']}, {found}; {error:.1e} off {reader}")
    print("all files are read and agree" if failed == 0 else f"{failed} files do not agree")
    sys.exit(1 if failed else 0)


main()
