"""Runs one case with one code; every code gives the same figures."""
import os
import re
from dataclasses import dataclass

import cases
import launch

LOOP = re.compile(r"Loop time of ([\d.eE+-]+) on \d+ procs for (\d+) steps with (\d+) atoms")


@dataclass
class Outcome:
    """Of one run."""
    rate: float      # million particle-steps per second
    seconds: float   # of the loop
    kinetic: float   # energy after the run, rotation too [J]
    contacts: int    # touching pairs of particles after the run
    extra: dict


class Barchan:
    def __init__(self, path, vector, arguments):
        self.path, self.vector, self.arguments = path, vector, arguments
        self.name = "barchan" if vector == "auto" else f"barchan {vector}"

    def has(self, _case):
        """Whether there are inputs for it."""
        return True

    def run(self, case, inputs, ranks, steps, work):
        out = os.path.join(work, case.name, "barchan.out")
        arguments = ["--steps", str(steps), "--vector", self.vector, *self.arguments]
        r = launch.run_barchan(self.path, cases.deck(case), out, ranks, arguments, cases.settings(case, inputs))
        keys = ("rebuilds", "memory_bytes_per_particle", "phases", "vector", "skin", "state_digest", "communication")
        return Outcome(r["particle_steps_per_second"] / 1e6, r["loop_seconds"], r["energy"]["kinetic"], r["contacts"],
                       {key: r.get(key) for key in keys})


class Peer:
    """LAMMPS or LIGGGHTS: the same input language, nearly, and the same log."""

    def __init__(self, name, folder, path, skin):
        self.name, self.folder, self.path, self.skin = name, folder, path, skin

    def has(self, case):
        """Whether there are inputs for it."""
        return os.path.exists(cases.script(case, self.folder))

    def run(self, case, inputs, ranks, steps, work):
        data = inputs.lammps if self.folder == "lammps" else inputs.liggghts
        log = os.path.join(work, case.name, f"{self.folder}.log")
        variables = {"data": data, "steps": steps, "width": f"{float(case.hi[0]):g}"}
        if self.skin is not None:
            variables["skin"] = self.skin
        command = [self.path, "-in", cases.script(case, self.folder), "-log", log, "-screen", "none"]
        for name, value in variables.items():
            command += ["-var", name, str(value)]
        launch.run(command, ranks, cwd=os.path.join(work, case.name))
        with open(log) as file:
            return self.read(file.read(), log)

    def read(self, text, log):
        found = LOOP.search(text)
        if not found:
            raise launch.Failed(f"{self.name} wrote no loop time into {log}")
        seconds, steps, atoms = float(found[1]), int(found[2]), int(found[3])
        last = [line for line in text[:found.start()].splitlines() if line.strip()][-1].split()
        if int(last[0]) != steps or int(last[1]) != atoms:
            raise launch.Failed(f"{self.name} lost particles or steps: {' '.join(last)} in {log}")
        neighbours = re.search(r"Neighbor list builds = (\d+)", text)
        return Outcome(steps * atoms / seconds / 1e6, seconds, float(last[2]) + float(last[3]), round(float(last[4]) / 2),
                       {"rebuilds": int(neighbours[1]) if neighbours else None})
