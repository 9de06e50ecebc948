"""MuJoCo's flex on the clamped beam that tissue methods are compared on: one JSON object.

Called by studies, through the `mujoco_peer` that tests/bench/mujoco_setup lays beside the other
peers. Not part of trocar. SI units; gravity along -y; the end x = 0 is held.

The work is ours: the same grid in six tetrahedra a cell (tissue::box_mesh), the mass of an element
shared equally among its corners, one time step, from the straight state. MuJoCo runs as it comes
with integrator="discrete" (linearly implicit, block Jacobi conjugate gradients); --iterations and
--tolerance change what it stops at. Its elements are linear, of St. Venant-Kirchhoff's energy.

linear_residual is |b - A a| / |b| of each step's system A a = b in the accelerations, with
A = M + h D + h^2 K and b = the forces + h K v as MuJoCo assembled them (mjData.efm_*, M,
qfrc_smooth): what its own solver left, not an estimate of ours. Once |b| is below 1e-6 of the first
step's, the beam hangs still and MuJoCo solves nothing: such steps count as at rest, in no time and
no residual.
"""
import argparse
import itertools
import json
import platform
import sys
import time

LENGTH_M = (0.2, 0.04, 0.04)
SETTLED_MPS = 1e-4  # of the fastest node
AT_REST = 1e-6  # of the first step's right side


def arguments():
    def cells(text):
        try:
            counts = tuple(int(word) for word in text.split("x"))
        except ValueError:
            counts = ()
        if len(counts) != 3 or min(counts) < 1:
            raise argparse.ArgumentTypeError(f"'{text}' is not NXxNYxNZ, each from 1")
        return counts

    def number(least, greatest):
        def take(text):
            try:
                value = float(text)
            except ValueError:
                value = float("nan")
            if not least <= value <= greatest:
                raise argparse.ArgumentTypeError(f"'{text}' is no number in {least}..{greatest}")
            return value
        return take

    p = argparse.ArgumentParser(prog="mujoco_peer", description=__doc__.splitlines()[0])
    p.add_argument("--cells", type=cells, default=(10, 3, 3), metavar="NXxNYxNZ")
    p.add_argument("--young", type=number(1.0, 1e12), default=1e5, metavar="PA")
    p.add_argument("--poisson", type=number(0.0, 0.4999), default=0.45)
    p.add_argument("--density", type=number(1e-3, 1e6), default=1000.0, metavar="KGPM3")
    p.add_argument("--gravity", type=number(-1e3, 1e3), default=9.81, metavar="MPS2")
    p.add_argument("--dt", type=number(1e-6, 1.0), default=0.01, metavar="S")
    p.add_argument("--steps", type=number(1, 1e7), default=1000)
    p.add_argument("--iterations", type=number(1, 1e6), help="of the linear solver; MuJoCo's: 100")
    p.add_argument("--tolerance", type=number(0.0, 1.0), help="relative; MuJoCo's: 1e-8")
    p.add_argument("--mass", choices=["lumped", "equal"], default="lumped",
                   help="equal: the same at every node, as MuJoCo's flexcomp makes it")
    return p.parse_args()


ARGUMENTS = arguments()  # before the imports: --help and bad input need no library

import mujoco  # noqa: E402
import numpy as np  # noqa: E402


def grid(cells):
    """Nodes (n x 3) and tetrahedra (m x 4) of positive volume, x fastest."""
    nx, ny, nz = cells
    steps = itertools.product(range(nz + 1), range(ny + 1), range(nx + 1))
    node = np.array([(i, j, k) for k, j, i in steps]) / cells * LENGTH_M
    stride = (1, nx + 1, (nx + 1) * (ny + 1))
    tets = []
    for k, j, i in itertools.product(range(nz), range(ny), range(nx)):
        for axes in itertools.permutations(range(3)):
            corner = [i + stride[1] * j + stride[2] * k]
            for axis in axes:
                corner.append(corner[-1] + stride[axis])
            tets.append(corner)
    tets = np.array(tets)
    edge = node[tets[:, 1:]] - node[tets[:, :1]]
    turned = np.linalg.det(edge) < 0
    tets[turned] = tets[turned][:, [0, 1, 3, 2]]
    return node, tets, np.abs(np.linalg.det(edge)) / 6


def masses(node, tets, volume, density, kind):
    if kind == "equal":
        return np.full(len(node), density * volume.sum() / len(node))
    mass = np.zeros(len(node))
    np.add.at(mass, tets.ravel(), np.repeat(density * volume / 4, 4))
    return mass


def words(values):
    return " ".join(repr(float(v)) for v in np.ravel(values))


def model_text(o, node, tets, mass):
    """A body with three slides at every free node, as flexcomp would make them."""
    slides = "".join(f'<joint type="slide" axis="{a}"/>' for a in ("1 0 0", "0 1 0", "0 0 1"))
    bodies = []
    for i, x in enumerate(node):
        place = f'<body name="n{i}" pos="{words(x)}">'
        if x[0] > 1e-9:
            inertia = words([1e-6 * mass[i]] * 3)  # no joint turns it
            place += (f'<inertial pos="0 0 0" mass="{float(mass[i])!r}" '
                      f'diaginertia="{inertia}"/>{slides}')
        bodies.append(place + "</body>")
    names = " ".join(f"n{i}" for i in range(len(node)))
    elements = " ".join(map(str, tets.ravel()))
    return (f'<mujoco><option timestep="{o.dt!r}" integrator="discrete" '
            f'gravity="0 {-o.gravity!r} 0"><flag contact="disable"/></option>'
            f'<size memory="4G"/><worldbody>{"".join(bodies)}</worldbody><deformable>'
            f'<flex name="beam" dim="3" radius="1e-4" body="{names}" element="{elements}">'
            f'<elasticity young="{o.young!r}" poisson="{o.poisson!r}" damping="0"/>'
            f'<contact selfcollide="none"/></flex></deformable></mujoco>')


class Residual:
    """|b - A a| and |b| of the system that the last step solved. Not timed."""

    def __init__(self, model):
        self.dofs = model.nv
        self.mass_at = model.M_rowadr + model.M_rownnz - 1  # of slides, M is diagonal

    def __call__(self, data):
        row = np.repeat(np.arange(self.dofs), data.efm_K_rownnz)
        product = data.efm_K_val * data.qacc[data.efm_K_colind]
        left = np.bincount(row, product, self.dofs) + data.M[self.mass_at] * data.qacc
        if data.efm_diag.size:
            left += data.efm_diag * data.qacc
        right = data.qfrc_smooth + data.efm_c
        return np.linalg.norm(right - left), np.linalg.norm(right)


def spread(values):
    if not values:  # it never moved
        return dict.fromkeys(("mean", "p50", "p99", "max"))
    p50, p99 = np.percentile(values, [50, 99])
    return {"mean": float(np.mean(values)), "p50": float(p50), "p99": float(p99),
            "max": float(np.max(values))}


def middle_of_end(cells):
    """The node in the middle of the face x = L, or the two beside it on their element's edge."""
    nx, ny, nz = cells
    at = {(ny // 2, nz // 2), (ny - ny // 2, nz - nz // 2)}
    return [nx + (nx + 1) * (j + (ny + 1) * k) for j, k in sorted(at)]


def run(o):
    node, tets, volume = grid(o.cells)
    mass = masses(node, tets, volume, o.density, o.mass)
    model = mujoco.MjModel.from_xml_string(model_text(o, node, tets, mass))
    if o.iterations:
        model.opt.iterations = int(o.iterations)
    if o.tolerance is not None:
        model.opt.tolerance = o.tolerance
    data = mujoco.MjData(model)
    residual_of = Residual(model)
    end = middle_of_end(o.cells)
    tip, ms, wall_ms, residual = [], [], [], []
    first_right = 0.0
    for _ in range(int(o.steps)):
        wall, cpu = time.perf_counter(), time.process_time()
        mujoco.mj_step(model, data)
        cpu, wall = time.process_time() - cpu, time.perf_counter() - wall
        left, right = residual_of(data)
        first_right = first_right or right
        if right > AT_REST * first_right:
            ms.append(1e3 * cpu)
            wall_ms.append(1e3 * wall)
            residual.append(left / right)
        mujoco.mj_kinematics(model, data)
        mujoco.mj_flex(model, data)
        tip.append((data.flexvert_xpos[end].mean(axis=0) - node[end].mean(axis=0)).tolist())
    fastest_mps = float(np.linalg.norm(data.qvel.reshape(-1, 3), axis=1).max())
    unsolved = data.warning[mujoco.mjtWarning.mjWARN_INERTIA].number
    return {
        "peer": "mujoco", "method": "flex, integrator discrete", "energy": "St. Venant-Kirchhoff",
        "versions": {"mujoco": mujoco.__version__, "numpy": np.__version__,
                     "python": platform.python_version()},
        "cells": list(o.cells), "nodes": len(node), "tets": len(tets), "mass": o.mass,
        "young_pa": o.young, "poisson": o.poisson, "density_kgpm3": o.density,
        "gravity_mps2": o.gravity, "dt_s": o.dt, "steps": int(o.steps),
        "iterations": model.opt.iterations, "tolerance": model.opt.tolerance,
        "tip_m": tip[-1], "tip_each_step_m": tip,
        "cpu_ms": spread(ms), "wall_ms": spread(wall_ms),
        "linear_residual": {"first": float(residual[0]) if residual else None,
                            **spread(residual)},
        "steps_at_rest": int(o.steps) - len(ms),
        "steps_out_of_iterations": int(unsolved),
        "bad_states": int(sum(data.warning[w].number for w in (
            mujoco.mjtWarning.mjWARN_BADQPOS, mujoco.mjtWarning.mjWARN_BADQVEL,
            mujoco.mjtWarning.mjWARN_BADQACC))),
        "fastest_node_mps": fastest_mps, "settled": fastest_mps < SETTLED_MPS}


def main():
    mujoco.set_mju_user_warning(lambda text: None)  # counted above; no log file
    try:
        print(json.dumps(run(ARGUMENTS)))
    except (ValueError, mujoco.FatalError, AttributeError) as error:
        print(f"mujoco_peer: {error}", file=sys.stderr)
        return 2
    return 0


if __name__ == "__main__":
    sys.exit(main())
