#!/usr/bin/env python3
"""barchan from Python: spheres sink in oil until drag and weight balance (fluid.toml).

    python3 sink.py            or            mpirun -n 2 python3 sink.py

Loads are written in place. The first window is done twice, as an implicit coupling would do.
"""
import math
import pathlib

import barchan

VISCOSITY, DENSITY, FLUID, GRAVITY = 0.05, 2500.0, 970.0, 9.81


def couple(sim):
    """Drag and buoyancy on every sphere of this rank."""
    for brick in sim.owned():
        r = brick.radii[:, None]
        brick.forces[:] = -6.0 * math.pi * VISCOSITY * r * brick.velocities
        brick.forces[:, 2] += 4.0 / 3.0 * math.pi * brick.radii**3 * FLUID * GRAVITY


with barchan.Simulation(pathlib.Path(__file__).with_name("fluid.toml")) as sim:
    before = sim.save()
    for _ in range(2):
        sim.load(before)
        couple(sim)
        sim.run(10)

    r = 0.5e-3
    relaxation = DENSITY * 4 / 3 * math.pi * r**3 / (6 * math.pi * VISCOSITY * r)
    while sim.time < 20 * relaxation:
        couple(sim)
        sim.run(10)

    expected = 2 / 9 * (DENSITY - FLUID) * GRAVITY * r**2 / VISCOSITY
    velocities, digest = sim.gather("velocity"), sim.digest()
    if velocities is not None:  # rank 0
        speed = -velocities[1][:, 2].mean()
        print(f"{sim.num_particles} spheres sink at {1e3 * speed:.5f} mm/s, theory says {1e3 * expected:.5f} mm/s; "
              f"digest {digest}")
        assert abs(speed / expected - 1) < 1e-3
