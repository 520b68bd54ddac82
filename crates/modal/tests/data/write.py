"""Writes the small structures beside it with the programs that own their formats.

    pip install pyNastran==1.4.1 meshio==5.3.5 pyuff==2.5.8 pyyeti==1.4.7 'numpy<2'
    apt-get install calculix-ccx      (2.20)
    python write.py

One curved patch of shells with a bar: positions, elements and rigid motions as
modes. `expected.json` holds what readers must find: places in basic axes as
pyNastran finds them, and the motions by their formula. The punch and printed
files give displacements along the axes of each node, found here by differences
of pyNastran's own coordinate transformations.
"""

import json
import pathlib
import shutil
import subprocess
import tempfile

import meshio
import numpy as np
import pyuff
from pyNastran.bdf.bdf import BDF
from pyNastran.op4.op4 import OP4
from pyyeti.nastran import op4
from scipy.sparse import coo_matrix

HERE = pathlib.Path(__file__).parent

# Translation and rotation vector of each mode; eigenvalue; generalised mass.
MOTIONS = [([1.0, 0.01, 0.02], [0.05, 0.02, 0.01]), ([0.03, 0.5, 0.25], [0.04, 0.3, 0.02]),
           ([0.1, -0.2, 0.3], [0.4, -0.5, 0.6])]
EIGENVALUES = [2500.0, 10000.0, 40000.0]
MASSES = [1.0, 2.5, 0.125]


def model():
    """Nodes in frames of every kind, elements of every shell, a bar, rigid elements."""
    bdf = BDF(debug=None)
    bdf.add_cord2r(10, [1.0, 2.0, 0.5], [1.0, 2.5, 1.5], [2.0, 2.0, 0.75])
    bdf.add_cord2c(20, [0.2, 0.1, 0.0], [0.2, 0.1, 3.0], [1.2, 0.3, 0.0], rid=10)
    bdf.add_cord2s(30, [0.0, 0.0, 1.0], [0.1, 0.0, 2.0], [1.0, 0.2, 1.0], rid=20)
    bdf.add_cord1r(40, 1, 2, 3)
    frames = [0, 10, 20, 30, 40]
    number = 0
    # Corners and midsides of an eight-node, a six-node and linear elements.
    for row in range(5):
        for column in range(5):
            number += 1
            placed = frames[number % 5] if number > 3 else 0
            moves = frames[(2 * number + row) % 5]
            angle = 10.0 * column
            place = {
                0: [0.25 * row, 0.5 * column, 0.03 * row * column + (0.4 if number == 3 else 0.0)],
                10: [0.3 * row, 0.2 * column, 0.1],
                20: [1.0 + 0.25 * row, angle, 0.5 * column],
                30: [1.5 + 0.125 * row, 40.0 + angle, 15.0 * row],
                40: [0.2 * row, -0.35 * column, 0.5],
            }[placed]
            bdf.add_grid(100 * row + column + 1, place, cp=placed, cd=moves)
    at = lambda row, column: 100 * row + column + 1
    bdf.add_cquad8(11, 1, [at(0, 0), at(2, 0), at(2, 2), at(0, 2), at(1, 0), at(2, 1), at(1, 2), at(0, 1)])
    bdf.add_ctria6(12, 1, [at(2, 0), at(4, 0), at(2, 2), at(3, 0), at(3, 1), at(2, 1)])
    bdf.add_cquad4(13, 2, [at(0, 2), at(2, 2), at(2, 4), at(0, 4)])
    bdf.add_ctria3(14, 2, [at(2, 2), at(4, 2), at(4, 4)])
    bdf.add_cquadr(15, 2, [at(2, 3), at(3, 3), at(3, 4), at(2, 4)])
    bdf.add_ctriar(16, 2, [at(3, 2), at(4, 3), at(3, 3)])
    bdf.add_cbar(17, 3, [at(4, 0), at(4, 1)], [0.0, 0.0, 1.0], None)
    bdf.add_rbe2(18, at(4, 2), "123456", [at(3, 2), at(3, 3)])
    for pid, thickness in [(1, 0.01), (2, 0.02)]:
        bdf.add_pshell(pid, 5, thickness)
    bdf.add_pbar(3, 5, A=1.0)
    bdf.add_mat1(5, 7.0e10, None, 0.3, rho=2700.0)
    return bdf


def local_axes(node):
    """Tangents of the coordinate lines of the node's displacement frame, as columns."""
    place = node.get_position()
    frame = node.cd_ref
    if node.Cd() == 0:
        return np.eye(3)
    local = frame.transform_node_to_local(place)
    kind = frame.type[-1]
    steps = np.ones(3)
    if kind != "R":
        steps[1] = np.degrees(1.0 / local[0])
    if kind == "S":
        steps[2] = np.degrees(1.0 / (local[0] * np.sin(np.radians(local[1]))))
    axes = np.zeros((3, 3))
    for axis in range(3):
        step = np.zeros(3)
        step[axis] = 1e-5 * steps[axis]
        forth = frame.transform_node_to_global(local + step)
        back = frame.transform_node_to_global(local - step)
        axes[:, axis] = (forth - back) / 2e-5
    return axes


def number(value, digits=6):
    return f"{value:.{digits}E}"


def punch(ids, shapes):
    """Lines of 72 columns and their number, as in genuine files."""
    lines = []
    for k, shape in enumerate(shapes):
        lines += ["$TITLE   = A CURVED PATCH", "$SUBTITLE=", "$LABEL   =", "$EIGENVECTOR",
                  "$REAL OUTPUT", "$SUBCASE ID =           1",
                  f"$EIGENVALUE =  {number(EIGENVALUES[k], 7)}  MODE = {k + 1:5d}"]
        for node, values in zip(ids, shape):
            head = f"{node:10d}       G"
            lines.append(f"{head:<18}" + "".join(f"{number(v):>18}" for v in values[:3]))
            lines.append(f"{'-CONT-':<18}" + "".join(f"{number(v):>18}" for v in values[3:]))
    return "".join(f"{line:<72}{k + 1:8d}\n" for k, line in enumerate(lines))


def printed(ids, shapes):
    """Pages of at most twelve nodes, with headings as in genuine files."""
    page = "1    A CURVED PATCH                                     JANUARY   1, 2026  NASTRAN  PAGE {:5d}\n\n0\n"
    text = "1\n\n0        N A S T R A N    E X E C U T I V E    C O N T R O L    E C H O\n\n"
    text += page.format(2) + " " * 46 + "R E A L   E I G E N V A L U E S\n"
    text += "   MODE    EXTRACTION      EIGENVALUE            RADIANS             CYCLES            GENERALIZED         GENERALIZED\n"
    text += "    NO.       ORDER                                                                       MASS              STIFFNESS\n"
    for k, (value, mass) in enumerate(zip(EIGENVALUES, MASSES)):
        numbers = [value, value**0.5, value**0.5 / (2 * np.pi), mass, value * mass]
        text += f"{k + 1:9d}{k + 1:10d}" + "".join(f"{number(v):>20}" for v in numbers) + "\n"
    sheet = 2
    for k, shape in enumerate(shapes):
        for first in range(0, len(ids), 12):
            sheet += 1
            text += page.format(sheet) + f"      EIGENVALUE =  {number(EIGENVALUES[k])}\n"
            cycles = number(EIGENVALUES[k] ** 0.5 / (2 * np.pi))
            text += f"          CYCLES =  {cycles}         R E A L   E I G E N V E C T O R   N O .{k + 1:11d}\n \n"
            text += "      POINT ID.   TYPE          T1             T2             T3             R1             R2             R3\n"
            for node, values in list(zip(ids, shape))[first : first + 12]:
                text += f"{node:14d}      G" + "".join(f"{number(v):>15}" for v in values) + "\n"
    return text + page.format(sheet + 1) + "                    * * * END OF JOB * * *\n"


def nastran():
    bdf = model()
    for size, name in [(8, "patch_small.bdf"), (16, "patch_large.bdf")]:
        bdf.write_bdf(HERE / name, size=size, is_double=size == 16, interspersed=False)
    # Places are those of the written digits.
    bdf = BDF(debug=None)
    bdf.read_bdf(HERE / "patch_large.bdf", punch=True)
    ids = sorted(bdf.nodes)
    places = np.array([bdf.nodes[n].get_position() for n in ids])
    axes = [local_axes(bdf.nodes[n]) for n in ids]
    basic = [
        np.array([np.hstack([np.add(t, np.cross(w, p)), w]) for p in places]) for t, w in MOTIONS
    ]
    local = [
        np.array([np.hstack([a.T @ row[:3], a.T @ row[3:]]) for a, row in zip(axes, shape)])
        for shape in basic
    ]
    (HERE / "patch.pch").write_text(punch(ids, local))
    (HERE / "patch.f06").write_text(printed(ids, local))
    columns = np.column_stack([shape.ravel() for shape in local])
    matrices = {"PHIG": columns, "LAMA": np.array([EIGENVALUES]).T}
    for name, form in [("dense", np.asarray), ("sparse", coo_matrix)]:
        text = {key: (2, form(matrix)) for key, matrix in matrices.items()}
        file = str(HERE / f"patch_text_{name}.op4")
        OP4(debug=False).write_op4(file, text, ["PHIG", "LAMA"], is_binary=False)
    for name, sparse, endian in [("dense", "dense", "<"), ("sparse", "nonbigmat", ">"),
                                 ("big", "bigmat", "<"), ("big_endian", "dense", ">")]:
        op4.write(str(HERE / f"patch_binary_{name}.op4"), matrices, binary=True,
                  sparse=sparse, endian=endian)
    elements = {str(k): [n for n in e.node_ids] for k, e in sorted(bdf.elements.items())}
    return {"nodes": {str(n): p.tolist() for n, p in zip(ids, places)}, "elements": elements,
            "motions": MOTIONS, "eigenvalues": EIGENVALUES, "masses": MASSES}


def plate():
    """Three eight-node shells in a row, folded, and the modes on them."""
    points, cells = [], []
    index = {}
    for k in range(3):
        ring = [(2 * k, 0), (2 * k + 2, 0), (2 * k + 2, 2), (2 * k, 2),
                (2 * k + 1, 0), (2 * k + 2, 1), (2 * k + 1, 2), (2 * k, 1)]
        for x, y in ring:
            if (x, y) not in index:
                index[x, y] = len(points)
                points.append([0.5 * x, 0.25 * y, 0.1 * max(x - 2, 0)])
        cells.append([index[p] for p in ring])
    points, cells = np.array(points), np.array(cells)
    shapes = [np.array([np.add(t, np.cross(w, p)) for p in points]) for t, w in MOTIONS]
    return points, cells, shapes


def gmsh():
    points, cells, shapes = plate()
    names = [f"mode {k + 1}, {v**0.5 / (2 * np.pi)!r} Hz" for k, v in enumerate(EIGENVALUES)]
    names = [name.replace("np.float64(", "").replace(")", "") for name in names]
    mesh = meshio.Mesh(points, [("quad8", cells)], point_data=dict(zip(names, shapes)))
    for style in ["gmsh22", "gmsh"]:
        for binary in [False, True]:
            name = f"plate_{'22' if style == 'gmsh22' else '41'}_{'binary' if binary else 'text'}.msh"
            meshio.write(HERE / name, mesh, file_format=style, binary=binary)
    return {"points": points.tolist(), "cells": cells.tolist(), "shapes": [s.tolist() for s in shapes]}


def response():
    """A measured response in binary, whose bytes hold a line that ends datasets."""
    end = np.frombuffer(b"\n    -1\n", "<f8")[0]
    units = {
        f"{axis}_{what}": 0
        for axis in ["abscissa", "ordinate", "orddenom", "z_axis"]
        for what in ["spec_data_type", "len_unit_exp", "force_unit_exp", "temp_unit_exp"]
    }
    labels = {f"{axis}_axis_units_lab": "NONE" for axis in ["abscissa", "ordinate", "orddenom", "z_axis"]}
    return pyuff.prepare_58(
        binary=1, func_type=4, ver_num=0, load_case_id=0, rsp_ent_name="FRF", rsp_node=1, rsp_dir=1,
        ref_ent_name="FRF", ref_node=1, ref_dir=1, ord_data_type=4, num_pts=64, abscissa_spacing=1,
        abscissa_min=0.0, abscissa_inc=1.0, z_axis_value=0.0, x=np.arange(64.0),
        data=np.full(64, end), **{f"id{k}": "NONE" for k in range(1, 6)}, **units, **labels,
    )


def universal():
    points, cells, shapes = plate()
    ids = np.arange(1, len(points) + 1)
    file = HERE / "plate_55.unv"
    file.unlink(missing_ok=True)
    uff = pyuff.UFF(str(file))
    x, y, z = points.T
    zero = np.zeros(len(ids), dtype=int)
    uff.write_sets(pyuff.prepare_15(node_nums=ids, def_cs=zero, disp_cs=zero, color=zero, x=x, y=y, z=z), "add")
    uff.write_sets(response(), "add")
    for k, shape in enumerate(shapes):
        uff.write_sets(
            pyuff.prepare_55(
                model_type=1, id1="NONE", id2="NONE", id3="NONE", id4="NONE", id5="NONE",
                analysis_type=2, data_ch=2, spec_data_type=8, data_type=2, n_data_per_node=3,
                r1=shape[:, 0], r2=shape[:, 1], r3=shape[:, 2], load_case=1, mode_n=k + 1,
                node_nums=ids, freq=EIGENVALUES[k] ** 0.5 / (2 * np.pi), modal_m=MASSES[k],
                modal_damp_vis=0.0, modal_damp_his=0.0,
            ),
            "add",
        )


def results():
    """The same in dataset 2411 and 2414."""
    points, _, shapes = plate()
    ids = np.arange(1, len(points) + 1)
    file = HERE / "plate_2414.unv"
    file.unlink(missing_ok=True)
    uff = pyuff.UFF(str(file))
    zero = np.zeros(len(ids), dtype=int)
    x, y, z = points.T
    uff.write_sets(
        pyuff.prepare_2411(node_nums=ids, def_cs=zero, disp_cs=zero, color=zero, x=x, y=y, z=z), "add"
    )
    for k, shape in enumerate(shapes):
        fields = {f"record{r}_field{f}": 0 for r in (10, 11, 12, 13) for f in range(1, 9)}
        fields |= {"record10_field6": k + 1, "record12_field2": EIGENVALUES[k] ** 0.5 / (2 * np.pi),
                   "record12_field3": EIGENVALUES[k], "record12_field4": MASSES[k]}
        head = pyuff.prepare_2414(
            analysis_dataset_label=k + 1, analysis_dataset_name="modes", dataset_location=1,
            id1="NONE", id2="NONE", id3="NONE", id4="NONE", id5="NONE", model_type=1,
            analysis_type=2, data_characteristic=2, result_type=8, data_type=2,
            number_of_data_values_for_the_data_component=3,
        )
        uff.write_sets(head | fields | {"node_nums": ids, "data_at_node": shape}, "add")


def calculix():
    text = (HERE / "plate.inp").read_text()
    with tempfile.TemporaryDirectory() as folder:
        folder = pathlib.Path(folder)
        for name, word in [("plate_text", "FILE"), ("plate_binary", "OUTPUT")]:
            (folder / f"{name}.inp").write_text(text.replace("*NODE FILE", f"*NODE {word}"))
            subprocess.run(["ccx", name], cwd=folder, check=True, stdout=subprocess.DEVNULL)
            for ending in ["frd", "dat"]:
                shutil.copy(folder / f"{name}.{ending}", HERE)


def main():
    expected = {"patch": nastran(), "plate": gmsh()}
    universal()
    results()
    calculix()
    (HERE / "expected.json").write_text(json.dumps(expected, indent=1) + "\n")


main()
