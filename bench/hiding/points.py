"""One measurement: a program on a case, started on two hosts."""
import json
import os
import re
import shlex
import subprocess
import sys
from dataclasses import dataclass

import cases
import launch

HERE = os.path.dirname(os.path.abspath(__file__))
NETLAB = os.path.join(HERE, "..", "netlab", "netlab")
LOOP = re.compile(r"Loop time of ([\d.eE+-]+) on \d+ procs for (\d+) steps with (\d+) atoms")
SECONDS = 1800  # a run that takes longer hangs


class Case:
    """Settled soil, `copies` of 5,000 disks side by side, as files of both codes."""

    def __init__(self, size, copies, data, work):
        self.size = size
        self.case = cases.Case(f"hiding-{size}", f"2D soil, {size} disks", steps=0, copies=(copies, 1), **cases.SOIL)
        self.inputs = cases.prepare(self.case, data, work)
        self.num_particles = self.inputs.num_particles
        self.deck, self.settings = cases.deck(self.case), cases.settings(self.case, self.inputs)
        self.folder = os.path.join(work, self.case.name)


def packings(given, work, barchan):
    """The folder with soil2d-5k.csv: the given one, or one in the work folder, made where it is not there yet."""
    if given:
        return given
    data = os.path.join(work, "packings")
    if not os.path.exists(os.path.join(data, "soil2d-5k.csv")):
        launch.run([sys.executable, os.path.join(HERE, "..", "peers", "make_packings"), "--only", "soil",
                    "--out", data, "--barchan", barchan])
    return data


@dataclass(frozen=True)
class Network:
    delay: int | None  # one way [µs]; None: a real one
    has_even_price: bool = False

    @property
    def label(self):
        return "" if self.delay is None else f", {self.delay} µs{' at an even price' if self.has_even_price else ''}"

    def names(self):
        return {"delay_us": self.delay, **({"even_price": True} if self.has_even_price else {})}


def starter(options, network, program):
    """The words before a program's own, by which it runs on two hosts."""
    if options.launcher:
        return shlex.split(options.launcher)
    words = [NETLAB, "--hosts", "2", "--delay", f"{network.delay}us", "--rate", options.rate, "--mtu", options.mtu]
    if network.has_even_price:
        words.append("--even-price")
    if options.realtime:
        words.append("--realtime")
    if program.osc:
        words += ["--mca", "osc", program.osc]
    return words + ["--"]


def run(command, cwd=None):
    try:
        done = subprocess.run(command, cwd=cwd, env={**os.environ, **launch.ENVIRONMENT}, text=True,
                              stdout=subprocess.PIPE, stderr=subprocess.STDOUT, timeout=SECONDS)
    except subprocess.TimeoutExpired:
        raise launch.Failed(f"{shlex.join(command)}\nran into the limit of {SECONDS} s") from None
    if done.returncode != 0:
        raise launch.Failed(f"{shlex.join(command)}\nended with status {done.returncode}: {last_words(done.stdout)}")
    return done.stdout


def last_words(said):
    """What barchan complained of, or else the end of all that was said."""
    errors = [line for line in said.splitlines() if line.startswith("barchan: ")]
    return " ".join(errors) or said.strip()[-500:]


def run_barchan(start, path, case, steps, *arguments):
    """One run on a thread a rank. Returns (its run.json, what it said)."""
    out = os.path.join(case.folder, "barchan.out")
    command = [*start, path, "run", case.deck, "--out", out, "--force", "--threads", "1", "--steps", str(steps), *arguments]
    for key, value in case.settings.items():
        command += ["--set", f"{key}={value}"]
    said = run(command)
    with open(os.path.join(out, "run.json")) as file:
        return json.load(file), said


class Barchan:
    def __init__(self, path, exchange, schedule, osc):
        self.path, self.name, self.schedule, self.osc = path, exchange, schedule, osc
        self.label = f"{exchange}, {schedule}"

    def run(self, start, case, steps):
        if self.schedule.startswith("depth"):
            how = ["--depth", self.schedule.removeprefix("depth")]
        else:
            how = ["--progress", "thread"] if self.schedule == "thread" else ["--schedule", self.schedule]
        result, _ = run_barchan(start, self.path, case, steps, "--quiet", "--exchange", self.name, *how)
        times = result["communication"]
        per_step = 1e6 / max(1, result["steps"])
        work = sum(result["phases"][name] for name in ("forces", "bands", "search") if name in result["phases"])
        return {"step_us": per_step * result["loop_seconds"], "in_flight_us": per_step * times["in_flight_seconds"],
                "exposed_us": per_step * times["exposed_seconds"], "hidden": times["hidden_fraction"],
                "work_us": per_step * work, "exchange": result["exchange"], "transport": result["transport"],
                "rebuilds": result["rebuilds"], "kinds": {kind: per_step * times[kind]["exposed_seconds"]
                                                          for kind in ("halo", "rebuild", "reductions") if kind in times},
                "digest": result["state_digest"]}


class Lammps:
    name, schedule, osc, label = "LAMMPS", "", None, "LAMMPS"

    def __init__(self, path):
        self.path = path

    def run(self, start, case, steps):
        log = os.path.join(case.folder, "lammps.log")
        command = [*start, self.path, "-in", cases.script(case.case, "lammps"), "-log", log, "-screen", "none"]
        for name, value in (("data", case.inputs.lammps), ("steps", steps), ("width", f"{float(case.case.hi[0]):g}")):
            command += ["-var", name, str(value)]
        run(command, cwd=case.folder)
        with open(log) as file:
            found = LOOP.search(file.read())
        if not found:
            raise launch.Failed(f"LAMMPS wrote no loop time into {log}")
        return {"step_us": 1e6 * float(found[1]) / int(found[2])}
