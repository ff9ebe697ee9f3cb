"""Particle files of other programs start runs; bonds go through snapshots and every format."""
import csv
import gzip
import os

from _helper import expect, finish, fresh, messages, run, write

BEAM = """
dimension = 2
gravity = [0.0, -9.81]
domain = { lo = [-0.2, -1.0], hi = [2.2, 1.0] }
time = { step = 1e-4, steps = 2000 }
material = [{ name = "m", density = 1000.0, normal_stiffness = 1e6 }]
bond = [{ name = "glue", young_modulus = 1e7, damping_ratio = 0.3 }]
output = { picture = false }
[[particles]]
material = "m"
bond = "glue"
fixed = { lo = [0.0, -0.05], hi = [0.11, 0.05] }
"""
LATTICE = 'kind = "lattice"\nregion = { lo = [0.0, -0.05], hi = [1.0, 0.05] }\nradius = 0.05\n'

CASE = """
dimension = 2
domain = { lo = [0.0, 0.0], hi = [1.0, 1.0] }
time = { step = 1e-6, steps = 1 }
output = { picture = false }
material = [{ name = "m", density = 2650.0, normal_stiffness = 1e6 }]
particles = [{ kind = "file", path = "PATH" }]
"""

SNAPSHOT = "beam.out/snapshots/step_000002000.pvtp"


def rows_of(path):
    with open(path, encoding="utf-8") as file:
        return list(csv.DictReader(file))


def bonds_of(path):
    """Bonds of any file as rows of text, in order."""
    fresh("look.csv", "look_bonds.csv")
    done = run("convert", path, "look.csv")
    expect(done.returncode == 0, f"convert {path}: {done}")
    return sorted(tuple(row.values()) for row in rows_of("look_bonds.csv"))


def check_bonds_of_a_run():
    write("beam.toml", BEAM + LATTICE)
    seen = []
    for ranks in (1, 2, 3):
        fresh("beam.out")
        done = run("run", "beam.toml", "--quiet", ranks=ranks)
        expect(done.returncode == 0, f"beam on {ranks} ranks: {done.stderr}")
        seen.append(bonds_of(SNAPSHOT))
    expect(len(seen[0]) == 9, f"{len(seen[0])} bonds in the last snapshot")
    expect(seen[0] == seen[1] == seen[2], "bonds differ between ranks")
    expect(all(abs(float(bond[3]) - 0.1) < 1e-12 for bond in seen[0]), f"lengths: {seen[0]}")
    expect(any(float(bond[4]) != 0.0 for bond in seen[0]), "no bond of a loaded beam has a shear force")


def check_conversions():
    bonds = bonds_of(SNAPSHOT)
    files = [SNAPSHOT, "b1.csv", "b2.data", "b3.vtp", "b4.lmp", "b5.csv", "b6.vtp", "b7.csv"]
    fresh(*files[1:], "b1_bonds.csv", "b3_bonds.vtp", "b5_bonds.csv", "b6_bonds.vtp", "b7_bonds.csv")
    for source, target in zip(files, files[1:]):
        done = run("convert", source, target)
        expect(done.returncode == 0 and "10 disks, 9 bonds" in done.stdout, f"convert {source} {target}: {done}")
        expect(bonds_of(target) == bonds, f"{source} to {target} changed bonds")
        expect("bonds" in run("info", target).stdout, f"info {target} shows no bonds")
    fresh("b1_bonds.csv")
    done = run("convert", "b1.csv", "b7.csv", "--force")
    expect(done.returncode == 0 and not os.path.exists("b7_bonds.csv"), f"bonds of an older file stay: {done}")


def check_new_starts():
    """A run from a beam's file has its bonds, and hangs on where the beam was."""
    before = rows_of("beam.out/series.csv")[-1]
    for path in (SNAPSHOT, "b1.csv", "b2.data", "b3.vtp"):
        if path == "b1.csv":
            run("convert", SNAPSHOT, "b1.csv", "--force")
        write("next.toml", BEAM + f'kind = "file"\npath = "{path}"\n')
        fresh("next.out")
        done = run("run", "next.toml", "--steps", "1", "--quiet", ranks=2)
        expect(done.returncode == 0, f"start from {path}: {done.stderr}")
        first = rows_of("next.out/series.csv")[0]
        expect(first["bonds"] == "9", f"{path}: {first['bonds']} bonds")
        expect(abs(float(first["elastic_energy"]) - float(before["elastic_energy"]))
               <= 1e-12 * float(before["elastic_energy"]), f"{path}: another energy of bonds")
    write("apart.csv", "id,type,radius,density,x,y\n1,1,0.05,1000,0.3,0\n2,1,0.05,1000,0.6,0\n")
    write("next.toml", BEAM + 'kind = "file"\npath = "apart.csv"\n')
    done = run("check", "next.toml")
    expect(done.returncode == 2 and "links nothing" in done.stderr and "next.toml:" in done.stderr,
           f"a bond that links nothing: {done}")
    fresh("b1_bonds.csv")
    write("next.toml", BEAM + 'kind = "file"\npath = "b1.csv"\nbond_gap = 0.01\n')
    expect("9 bonds" in run("check", "next.toml").stdout, "bond_gap links no beam")


def start(path, text=None, deck=CASE):
    """The rows of the first snapshot of a run from a file, or what went wrong."""
    if text is not None:
        write(path, text)
    write("case.toml", deck.replace("PATH", path))
    fresh("case.out", "start.csv")
    done = run("run", "case.toml", "--quiet")
    if done.returncode != 0:
        return None, done
    run("convert", "case.out/snapshots/step_000000000.pvtp", "start.csv")
    return rows_of("start.csv"), done


def check_tables():
    solid = CASE.replace("dimension = 2", "dimension = 3").replace("[0.0, 0.0]", "[0.0, 0.0, 0.0]")
    solid = solid.replace("[1.0, 1.0]", "[1.0, 1.0, 1.0]")
    text = ("id,type,radius,density,x,y,z,Vx,Vy,Vz\n1,1,0.01,2650,0.1,0.1,0.1,1,0,0\n"
            "2,1,0.012,2650,0.2,0.1,0.1,-1,0,0\n")
    rows, done = start("capital.csv", text, solid)
    expect(rows is not None and [float(r["vx"]) for r in rows] == [1.0, -1.0], f"Vx: {done}")
    names = ",".join(f'"{n}"' for n in ["id", "type", "radius", "density"] +
                     [f"{v}:{c}" for v in ("velocity", "angular_velocity") for c in range(3)] + ["rank", "x", "y", "z"])
    rows, done = start("paraview.csv", names + "\n1,1,0.01,2650,1,0,0,0,0,3,0,0.1,0.1,0.1\n", solid)
    expect(rows is not None and (float(rows[0]["vx"]), float(rows[0]["omegaz"])) == (1.0, 3.0), f"velocity:0: {done}")
    expect(messages(done) == ["barchan: warning: paraview.csv: columns not used: 'rank'"], f"notes: {done.stderr}")
    with open("case.out/log.txt", encoding="utf-8") as log:
        expect("columns not used: 'rank'" in log.read(), "log.txt has no note of columns")
    with gzip.open("packed.csv.gz", "wt") as file:
        file.write(text)
    rows, done = start("packed.csv.gz", None, solid)
    expect(rows is not None and len(rows) == 2, f"a packed table: {done}")
    for path in ("grains.xyz", "grains.dump", "grains.csv.bz2"):
        rows, done = start(path, text, solid)
        expect(done.returncode == 2 and path in done.stderr and ".pvtp" in done.stderr, f"{path}: {done}")


def mass_of_start(extra=""):
    """From gravity and height: potential energy = mass * g * y."""
    deck = CASE.replace('"PATH"', '"title.data"' + extra) + "\n"
    write("title.toml", deck.replace("dimension = 2", "dimension = 2\ngravity = [0.0, -1.0]"))
    fresh("title.out")
    done = run("run", "title.toml", "--quiet", "--steps", "0")
    expect(done.returncode == 0, f"title.data: {done.stderr}")
    return float(rows_of("title.out/series.csv")[0]["gravitational_energy"]) / 0.5


def check_lammps():
    rest = ("\n\n1 atoms\n1 atom types\n\n0 1 xlo xhi\n0 1 ylo yhi\n-0.1 0.1 zlo zhi\n\nAtoms # sphere\n\n"
            "1 1 0.02 2500 0.5 0.5 0\n")
    pi = 3.141592653589793
    for title in ("LAMMPS data file", "# LIGGGHTS data made by a script"):
        write("title.data", title + rest)
        sphere, disk = mass_of_start(), mass_of_start(', data_density = "disk"')
        expect(abs(sphere - 4 / 3 * pi * 0.01**3 * 2500) < 1e-12, f"{title}: mass {sphere}")
        expect(abs(disk - pi * 0.01**2 * 2500) < 1e-12, f"{title}: mass {disk}")
    write("title.data", "title" + rest.replace("0 1 xlo", "0 2 xlo"))
    write("case.toml", CASE.replace("PATH", "title.data"))
    done = run("check", "case.toml")
    expect(done.returncode == 0 and "its box is 0 … 2 × 0 … 1 m" in done.stderr, f"another box: {done}")
    fresh("disk.csv")
    run("convert", "title.data", "disk.csv", "--data-density", "disk")
    expect(rows_of("disk.csv")[0]["density"] == "2500", "convert --data-density disk")


check_bonds_of_a_run()
check_conversions()
check_new_starts()
check_tables()
check_lammps()
finish()
