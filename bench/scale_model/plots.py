"""Plots of the model. Needs python3-matplotlib; without it there are none, and a word about it."""
import os
import sys

COLOURS = {"strips": "#c0504d", "pencils": "#e0a030", "bricks": "#1f77b4"}


def matplotlib():
    """The module, or None where it is not installed."""
    try:
        import matplotlib
        matplotlib.use("Agg")
        matplotlib.rcParams["svg.hashsalt"] = "barchan"
        from matplotlib import pyplot
        return pyplot
    except ImportError:
        print("no plots: apt install python3-matplotlib", file=sys.stderr)
        return None


def write(folder, data, networks):
    """Efficiency over ranks for weak and strong, a curve a shape, a panel a network. Returns the paths."""
    pyplot = matplotlib()
    paths = []
    for part in ("weak", "strong"):
        if pyplot is None or part not in data:
            continue
        keys = list(dict.fromkeys(row["network"] for row in data[part]))
        figure, axes = pyplot.subplots(1, len(keys), figsize=(5.5 * len(keys), 4), squeeze=False, sharey=True)
        for panel, key in zip(axes[0], keys):
            for shape, colour in COLOURS.items():
                points = [(r["ranks"], r["efficiency"]) for r in data[part] if (r["network"], r["shape"]) == (key, shape)]
                if points:
                    panel.semilogx(*zip(*points), "o-", color=colour, label=shape)
            panel.set(title=networks[key].name, xlabel="ranks", ylim=(0, 1.05))
            panel.grid(alpha=0.3)
        axes[0][0].set_ylabel(f"efficiency, {part} (modelled)")
        axes[0][-1].legend()
        figure.tight_layout()
        paths.append(os.path.join(folder, f"scale_model_{part}.svg"))
        figure.savefig(paths[-1], metadata={"Date": None})
        pyplot.close(figure)
    return paths
