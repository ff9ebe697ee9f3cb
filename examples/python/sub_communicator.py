#!/usr/bin/env python3
"""barchan on some of the ranks of a program under mpi4py (Debian: python3-mpi4py).

    mpirun -n 4 python3 sub_communicator.py

Half of the ranks run particles, the others stand for a solver of their own: they get the mean height of the particles
in every window, and send back the gravity of the next one, as a shaker would.
"""
import math
import pathlib

from mpi4py import MPI

import barchan

world = MPI.COMM_WORLD
is_solid = world.rank < (world.size + 1) // 2
ranks = world.Split(0 if is_solid else 1, world.rank)
shaker = (world.size + 1) // 2 if world.size > 1 else 0  # the first rank of the other half

deck = pathlib.Path(__file__).parent.parent / "coupling" / "fluid.toml"
sim = barchan.Simulation(deck, comm=ranks) if is_solid else None
for window in range(5):
    height = None
    if sim is not None:
        sim.run(50)
        positions = sim.gather("position")
        if positions is not None:
            height = positions[1][:, 2].mean()
    height = world.bcast(height, root=0)
    gravity = world.bcast([0.0, 0.0, -9.81 * (1 + 0.5 * math.sin(window))] if world.rank == shaker else None, root=shaker)
    if sim is not None:
        sim.set_gravity(gravity)
    if world.rank == shaker:
        print(f"window {window}: mean height {1e3 * height:.4f} mm, next gravity {gravity[2]:.3f} m/s²")
if sim is not None:
    sim.close()
