"""Plots of published's results. Needs python3-matplotlib; without it there are none, and a word about it."""
import os

import tables

COLOURS = {"published": "#777777", "all-pairs": "#c0504d", "cells": "#1f77b4"}
DASHES = {"put-flag": "-", "return": "--"}


def matplotlib():
    """The module, or None where it is not installed."""
    try:
        import matplotlib
        matplotlib.use("Agg")
        matplotlib.rcParams["svg.hashsalt"] = "barchan"
        from matplotlib import pyplot
        return pyplot
    except ImportError:
        return None


def curves(runs, particles):
    """{(search, exchange): [(ranks, seconds of the whole case), …]}"""
    found = {}
    for run in runs:
        if run["particles"] == particles:
            found.setdefault((run["search"], run["exchange"]), []).append((run["ranks"], run["full_seconds"]))
    return found


def times_and_speed_up(pyplot, runs, path):
    """One row a size: seconds on the left, speed-up on the right."""
    sizes = sorted({run["particles"] for run in runs})
    figure, axes = pyplot.subplots(len(sizes), 2, figsize=(11, 4.2 * len(sizes)), squeeze=False)
    for (left, right), size in zip(axes, sizes):
        published = tables.SECONDS[size]
        left.plot(tables.PROCESSES, published, "o-", color=COLOURS["published"], label="published")
        right.plot(tables.PROCESSES, tables.speed_up(published), "o-", color=COLOURS["published"], label="published")
        most = max(tables.PROCESSES)
        for (search, exchange), points in curves(runs, size).items():
            points.sort()
            ranks, seconds = zip(*points)
            look = {"color": COLOURS[search], "linestyle": DASHES[exchange], "marker": "s", "label": f"{search}, {exchange}"}
            left.plot(ranks, seconds, **look)
            right.plot(ranks, tables.speed_up(seconds) if ranks[0] == 1 else [float("nan")] * len(ranks), **look)
        right.plot([1, most], [1, most], ":", color="black", label="ideal")
        left.set(xscale="log", yscale="log", xlabel="processes", ylabel="seconds of 10,000 steps", title=f"{size:,} disks")
        right.set(xscale="log", yscale="log", xlabel="processes", ylabel="speed-up", title=f"{size:,} disks")
        left.legend(fontsize=8)
        right.legend(fontsize=8)
        for axis in (left, right):
            axis.set_xticks([1, 2, 5, 10, 20, 35], ["1", "2", "5", "10", "20", "35"])
            axis.minorticks_off()
            axis.grid(True, alpha=0.3)
    figure.tight_layout()
    figure.savefig(path, metadata={"Date": None} if path.endswith(".svg") else None)
    pyplot.close(figure)


def profiles(pyplot, shares, path):
    """Stacked bars: where the serial time goes, published and here. @param shares  {label: [(phase, share), …]}"""
    figure, axis = pyplot.subplots(figsize=(9, 1.7 + 0.6 * len(shares)))
    palette = pyplot.get_cmap("tab20").colors
    names = []
    for row, (label, parts) in enumerate(shares.items()):
        begin = 0.0
        for name, share in parts:
            if name not in names:
                names.append(name)
            axis.barh(row, share, left=begin, color=palette[names.index(name) % len(palette)],
                      label=name if name not in axis.get_legend_handles_labels()[1] else None)
            begin += share
    axis.set_yticks(range(len(shares)), list(shares))
    axis.invert_yaxis()
    axis.set(xlim=(0, 1), xlabel="share of the serial loop")
    axis.legend(fontsize=8, ncol=5, loc="upper center", bbox_to_anchor=(0.5, -0.9 / len(shares) - 0.05))
    figure.tight_layout()
    figure.savefig(path, metadata={"Date": None} if path.endswith(".svg") else None)
    pyplot.close(figure)


def draw(folder, runs, shares):
    """Writes the plots. Returns their names."""
    pyplot = matplotlib()
    if pyplot is None:
        print("no plots: apt install python3-matplotlib (and run this by /usr/bin/python3)")
        return []
    names = ["published_times.svg", "published_profile.svg"]
    times_and_speed_up(pyplot, runs, os.path.join(folder, names[0]))
    profiles(pyplot, shares, os.path.join(folder, names[1]))
    return names
