"""The packings that the peers run, and the input files of each code for them."""
import os
from dataclasses import dataclass

import particles

HERE = os.path.dirname(os.path.abspath(__file__))


@dataclass(frozen=True)
class Case:
    """One packing at one size."""
    name: str
    about: str
    kind: str          # names the deck and the input files
    source: str        # particles, a CSV in the data folder
    box: tuple         # of one copy [m]: lower and upper corner
    steps: int
    copies: tuple = (1, 1)
    bed_below: float = None  # particles with centres below never move; peers know them by type 2
    energy_tolerance: float = 0.05    # of kinetic energy after the run, relative
    contact_tolerance: float = 0.02

    @property
    def hi(self):
        lo, hi = self.box
        return (lo[0] + self.copies[0] * (hi[0] - lo[0]), lo[1] + self.copies[1] * (hi[1] - lo[1]), hi[2])


SOIL = {"kind": "soil2d", "source": "soil2d-5k.csv", "box": ((0, 0, -0.1), (10, 8, 0.1)), "energy_tolerance": 0.5}
PACK = {"kind": "pack3d", "source": "pack3d-30k.csv", "box": ((0, 0, 0), (30, 30, 43.5)), "energy_tolerance": 0.1}
CHUTE = {"kind": "chute3d", "source": "chute3d-32k.csv", "box": ((0, 0, -1), (40, 20, 60)), "bed_below": 0.0}


def pack(law):
    """The packing by another law; LIGGGHTS has no such input."""
    return {**PACK, "kind": f"pack3d_{law}"}


CASES = [
    Case("soil2d-5k", "2D soil, 5,000 disks", steps=10000, **SOIL),
    Case("soil2d-10k", "2D soil, 10,000 disks", steps=5000, copies=(2, 1), **SOIL),
    Case("soil2d-100k", "2D soil, 100,000 disks", steps=1000, copies=(20, 1), **SOIL),
    Case("pack3d-30k", "3D packing, 30,000 spheres", steps=1000, **PACK),
    Case("pack3d-120k", "3D packing, 120,000 spheres", steps=300, copies=(2, 2), **PACK),
    Case("pack3d-1m", "3D packing, 1,080,000 spheres", steps=60, copies=(6, 6), **PACK),
    Case("pack3d-30k-hertz", "3D packing, 30,000 spheres, Hertz–Mindlin", steps=500, **pack("hertz")),
    Case("pack3d-30k-rolling", "3D packing, 30,000 spheres, with rolling and twisting", steps=500, **pack("rolling")),
    Case("pack3d-30k-jkr", "3D packing, 30,000 spheres, JKR", steps=500, **pack("jkr")),
    Case("chute3d-32k", "3D chute flow, 32,000 spheres", steps=1000, **CHUTE),
]
USUAL = ["soil2d-5k", "soil2d-100k", "pack3d-30k", "pack3d-120k", "chute3d-32k"]


@dataclass
class Inputs:
    """What the codes start from."""
    csv: str
    lammps: str
    liggghts: str
    num_particles: int


def prepare(case, data, work):
    """Writes the same particles for every code into the work folder."""
    folder = os.path.join(work, case.name)
    os.makedirs(folder, exist_ok=True)
    lo, hi = case.box
    size = [hi[c] - lo[c] for c in range(3)]
    rows = particles.replicate(particles.read_csv(os.path.join(data, case.source)), size, case.copies)
    paths = [os.path.join(folder, name) for name in ("particles.csv", "lammps.data", "liggghts.data")]
    particles.write_csv(paths[0], rows)
    if case.bed_below is not None:
        rows = [{**p, "type": 2 if p["z"] <= case.bed_below else 1} for p in rows]
    for path, flavour in zip(paths[1:], ("lammps", "liggghts")):
        particles.write_data(path, rows, lo, case.hi, flavour)
    return Inputs(*paths, len(rows))


def settings(case, inputs):
    """What differs from the deck as it stands."""
    dimension = 2 if case.kind.startswith("soil2d") else 3
    lists = {"particles.1.path": f'"{inputs.csv}"',
             "domain.hi": [float(value) for value in case.hi[:dimension]]}
    if case.kind == "soil2d":
        lists["wall.right.point"] = [float(case.hi[0]), 0.0]
    return lists


def deck(case):
    return os.path.join(HERE, "decks", f"{case.kind}.toml")


def script(case, code):
    return os.path.join(HERE, code, f"in.{case.kind}")
