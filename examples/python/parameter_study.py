#!/usr/bin/env python3
"""A parameter study: how high does a ball bounce, for several restitutions?

    python3 parameter_study.py

The deck is a dict, and every run changes a key of it. A ball that falls by h comes back by e² h.
"""
import barchan

RADIUS, FALL = 0.05, 0.5
DECK = {
    "title": "a ball that bounces",
    "dimension": 3,
    "gravity": [0.0, 0.0, -9.81],
    "domain": {"lo": [0.0, 0.0, 0.0], "hi": [0.4, 0.4, 1.0]},
    "time": {"step": 5e-6, "end": 1.0},
    "material": [{"name": "rubber", "density": 1000.0, "normal_stiffness": 1e7, "restitution": 0.5}],
    "particles": [{"kind": "list", "material": "rubber",
                   "particle": [{"position": [0.2, 0.2, RADIUS + FALL], "radius": RADIUS}]}],
    "wall": [{"name": "floor", "point": [0.0, 0.0, 0.0], "normal": [0.0, 0.0, 1.0], "material": "rubber"}],
}


def rebound(restitution):
    """Height of the first bounce [m]."""
    with barchan.Simulation(DECK, set={"material.rubber.restitution": restitution}) as sim:
        highest, has_met = 0.0, False
        while True:
            sim.run(100)
            height = sim.gather("position")[1][0, 2] - RADIUS
            velocity = sim.gather("velocity")[1][0, 2]
            if not has_met:
                has_met = velocity > 0.0
            elif velocity <= 0.0:
                return highest
            highest = max(highest, height) if has_met else 0.0


for e in (0.3, 0.5, 0.7, 0.9):
    height = rebound(e)
    print(f"restitution {e:.1f}: bounces by {height:.4f} m, e² h = {e * e * FALL:.4f} m")
    assert abs(height / (e * e * FALL) - 1) < 0.02
