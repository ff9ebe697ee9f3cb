#!/usr/bin/env python3
"""Plots a run's energies and its last state (Debian: python3-matplotlib).

    barchan run ../column_collapse.toml && python3 plot_run.py column_collapse.out
"""
import sys

import matplotlib
matplotlib.use("Agg")
import matplotlib.pyplot as plt

import barchan

run = barchan.read(sys.argv[1])
figure, (left, right) = plt.subplots(1, 2, figsize=(11, 4.5))
for name in ("kinetic_energy", "elastic_energy"):
    if name in run.series:
        left.semilogy(run.series["time"], run.series[name], label=name.replace("_", " "))
left.set(xlabel="time [s]", ylabel="energy [J]")
left.legend()
last = run.snapshot()
up = 1 if run.figures["dimension"] == 2 else 2
points = right.scatter(last["position"][:, 0], last["position"][:, up], c=(last["velocity"]**2).sum(axis=1)**0.5, s=3)
figure.colorbar(points, label="speed [m/s]")
right.set(xlabel="x [m]", aspect="equal", title=f"step {run.steps[-1]}, digest {run.figures['state_digest']}")
figure.tight_layout()
figure.savefig("run.png", dpi=150)
print("run.png")
