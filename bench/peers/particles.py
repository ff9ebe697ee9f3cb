"""Particles as rows of numbers: reads barchan's CSV, replicates, writes the formats of all peers."""
import csv
import math

COLUMNS = ("id", "type", "radius", "density", "x", "y", "z", "vx", "vy", "vz", "omegax", "omegay", "omegaz")


def read_csv(path):
    """Particles as dicts of floats, in file order."""
    with open(path, newline="") as file:
        return [{name: float(row[name]) for name in COLUMNS} for row in csv.DictReader(file)]


def replicate(particles, box, times):
    """`times[c]` copies along each axis, `box[c]` apart; ids go on counting."""
    copies = []
    for i in range(times[0]):
        for j in range(times[1]):
            for p in particles:
                copies.append({**p, "id": len(copies) + 1, "x": p["x"] + i * box[0], "y": p["y"] + j * box[1]})
    return copies


def write_csv(path, particles):
    with open(path, "w") as file:
        file.write(",".join(COLUMNS) + "\n")
        for p in particles:
            values = [f"{p[name]:.17g}" for name in COLUMNS[2:]]
            file.write(f"{int(p['id'])},{int(p['type'])},{','.join(values)}\n")


def write_data(path, particles, lo, hi, flavour):
    """LAMMPS data of atom style sphere, or LIGGGHTS's of style granular, whose disks have areal densities.

    LAMMPS takes every particle for a sphere, so a disk's density is made such that its mass comes out right.
    """
    is_flat = hi[2] - lo[2] < 1.0
    num_types = int(max(p["type"] for p in particles))
    with open(path, "w") as file:
        file.write(f"particles\n\n{len(particles)} atoms\n{num_types} atom types\n\n")
        for c, axis in enumerate("xyz"):
            file.write(f"{lo[c]:.17g} {hi[c]:.17g} {axis}lo {axis}hi\n")
        file.write("\nAtoms # sphere\n\n" if flavour == "lammps" else "\nAtoms\n\n")
        for p in particles:
            density = p["density"]
            if is_flat and flavour == "lammps":
                density *= math.pi / (4.0 / 3.0 * math.pi * p["radius"])
            file.write(f"{int(p['id'])} {int(p['type'])} {2.0 * p['radius']:.17g} {density:.17g} "
                       f"{p['x']:.17g} {p['y']:.17g} {p['z']:.17g}\n")
        file.write("\nVelocities\n\n")
        for p in particles:
            values = [f"{p[name]:.17g}" for name in COLUMNS[7:]]
            file.write(f"{int(p['id'])} {' '.join(values)}\n")
