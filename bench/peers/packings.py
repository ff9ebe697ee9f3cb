"""Makes packings with barchan: settled soil, settled spheres, flow down a chute."""
import os
import random

import launch
import particles

HERE = os.path.dirname(os.path.abspath(__file__))
BED = (40, 20)        # fixed spheres along the chute and across
SURFACE_SPEED = 3.0   # of the flow at the start
CHUTE_STEPS = 50000


class Maker:
    """Runs decks and turns their last states into CSV files.

    @param steps  instead of the decks' own; None: as they say
    """

    def __init__(self, barchan, folder, ranks=1, steps=None):
        self.barchan, self.folder, self.ranks, self.steps = barchan, os.path.abspath(folder), ranks, steps
        os.makedirs(self.folder, exist_ok=True)

    def path(self, name):
        return os.path.join(self.folder, name)

    def run(self, deck, name, steps=None, settings=None):
        """Writes NAME.csv, the state after the run of the deck. Returns its path."""
        out, csv = self.path(f"{name}.out"), self.path(f"{name}.csv")
        arguments = ["--steps", str(steps)] if steps is not None else []
        result = launch.run_barchan(self.barchan, os.path.join(HERE, "decks", deck), out, self.ranks, arguments, settings)
        state = os.path.join(out, "snapshots", f"step_{result['steps']:09}.pvtp")
        launch.run([self.barchan, "convert", state, csv, "--dimension", str(result["dimension"]), "--force"])
        print(f"{csv}: {result['particles']:,} particles, {result['contacts'] / result['particles']:.3f} contacts each, "
              f"kinetic energy {result['energy']['kinetic']:.4g}", flush=True)
        return csv

    def soil(self, name="soil2d-5k", count=5000):
        """Disks 50 layers deep, settled in a box as wide as it takes."""
        width = count / 500.0
        settings = {"domain.hi": [width, 8.0], "wall.right.point": [width, 0.0], "particles.1.count": count,
                    "particles.1.region": f"{{ lo = [0.0, 0.0], hi = [{width}, 5.2] }}"}
        return self.run("settle_soil2d.toml", name, self.steps, settings)

    def pack(self, name="pack3d-30k", count=30000):
        """Spheres 32 layers deep, settled on a square floor, periodic along it. Returns (path, width)."""
        width = round(30.0 * (count / 30000.0) ** 0.5, 3)
        settings = {"domain.hi": [width, width, 43.5], "particles.1.count": count,
                    "particles.1.region": f"{{ lo = [0.0, 0.0, 0.0], hi = [{width}, {width}, 31.5] }}"}
        return self.run("settle_pack3d.toml", name, self.steps, settings), width

    def chute(self, name="chute3d-32k"):
        """Flow over a bed of fixed spheres: a random packing with the velocities of a steady flow, after Bagnold,
        v ~ 1 − (1 − z/h)^1.5, which then runs until its contacts and fluctuations are those of a flow."""
        flow = particles.read_csv(self.run("fill_chute3d.toml", "fill_chute3d"))
        rows = bed()
        top = max(p["z"] for p in flow)
        for p in flow:
            speed = SURFACE_SPEED * (1.0 - (1.0 - max(0.0, p["z"]) / top) ** 1.5)
            rows.append({**p, "id": len(rows) + 1, "vx": speed})
        start = self.path("chute3d-start.csv")
        particles.write_csv(start, rows)
        return self.run("chute3d.toml", name, CHUTE_STEPS if self.steps is None else self.steps,
                        {"particles.1.path": f'"{start}"'})


def bed():
    """Fixed spheres on a square lattice, of uneven height, centres not above z = 0."""
    uneven = random.Random(1)
    rows = []
    for i in range(BED[0]):
        for j in range(BED[1]):
            row = dict.fromkeys(particles.COLUMNS, 0.0)
            row.update(id=len(rows) + 1, type=1, radius=0.5, density=1.0, x=i + 0.5, y=j + 0.5, z=-0.3 * uneven.random())
            rows.append(row)
    return rows
