#!/usr/bin/env python3
"""A drag of your own: spheres sink in oil with the resistance of Schiller and Naumann (1935), in place of Stokes's.

    python3 custom_drag.py            or            mpirun -n 2 python3 custom_drag.py

on_step() calls a function within run(), before every tenth step; a field of your own keeps what each sphere lost to the oil.
"""
import math
import pathlib

import numpy as np

import barchan

VISCOSITY, DENSITY, FLUID, GRAVITY = 0.05, 2500.0, 970.0, 9.81
EVERY = 10


def resistance(r, speed):
    """Force over velocity [N·s/m]: Stokes's times 1 + 0.15 Re^0.687."""
    reynolds = FLUID * speed * 2.0 * r / VISCOSITY
    return 6.0 * math.pi * VISCOSITY * r * (1.0 + 0.15 * reynolds**0.687)


deck = pathlib.Path(__file__).parent.parent / "coupling" / "fluid.toml"
with barchan.Simulation(deck) as sim:
    sim.add_field("lost")  # [J]
    interval = EVERY * sim.info["dt"]

    def drag(bricks):
        for brick in bricks:
            r, v = brick.radii, brick.velocities
            speed = np.linalg.norm(v, axis=1)
            factor = resistance(r, speed)
            brick.forces[:] = -factor[:, None] * v
            brick.forces[:, 2] += 4.0 / 3.0 * math.pi * r**3 * FLUID * GRAVITY
            brick.field("lost")[:] += factor * speed**2 * interval

    sim.on_step(EVERY, drag)
    r = 0.5e-3
    sim.advance_to(20.0 * 2.0 / 9.0 * DENSITY * r**2 / VISCOSITY)

    weight = 4.0 / 3.0 * math.pi * r**3 * (DENSITY - FLUID) * GRAVITY
    expected = 0.0
    for _ in range(100):
        expected = weight / resistance(r, expected)
    velocities, lost = sim.gather("velocity"), sim.gather("lost")
    if velocities is not None:  # rank 0
        speed = -velocities[1][:, 2].mean()
        print(f"{sim.num_particles} spheres sink at {1e3 * speed:.5f} mm/s, theory says {1e3 * expected:.5f} mm/s; "
              f"the oil took {1e6 * lost[1].sum():.4g} µJ")
        assert abs(speed / expected - 1) < 1e-3
