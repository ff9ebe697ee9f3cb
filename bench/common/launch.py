"""Starts programs on cores of their own and reads what barchan says about its runs."""
import json
import os
import shutil
import subprocess
import sys
import threading
import time

from machine import SOURCE, num_cores

ENVIRONMENT = {"OMP_NUM_THREADS": "1", "OMPI_ALLOW_RUN_AS_ROOT": "1", "OMPI_ALLOW_RUN_AS_ROOT_CONFIRM": "1"}


class Failed(Exception):
    """A program did not do what it should; says which, and its last words."""


def environment(ranks):
    mine = {**os.environ, **ENVIRONMENT}
    if ranks > num_cores():
        mine["OMPI_MCA_mpi_yield_when_idle"] = "1"
    return mine


def pinned(command, ranks, threads=1):
    """The command on one core a thread; without pinning where they are more than cores."""
    if ranks == 1:
        cores = sorted(os.sched_getaffinity(0))[-threads:]
        return ["taskset", "-c", ",".join(map(str, cores)), *command]
    if threads > 1 or ranks > num_cores():
        return ["mpirun", "-n", str(ranks), "--oversubscribe", "--bind-to", "none", *command]
    return ["mpirun", "-n", str(ranks), "--bind-to", "core", "--map-by", "core", *command]


def find_barchan(given):
    """Path of the command: the given one, or the release build's, or the one in PATH."""
    for path in [given] if given else [os.path.join(SOURCE, "build/release/barchan"), shutil.which("barchan")]:
        if path and os.access(path, os.X_OK):
            return os.path.abspath(path)
    sys.exit("no barchan command: build it (cmake --preset release && cmake --build --preset release), "
             "or name it by --barchan PATH")


def peak_of_tree(root, peaks):
    """Notes the largest resident size so far [KiB] of every process below `root`."""
    parents = {}
    for name in os.listdir("/proc"):
        if not name.isdigit():
            continue
        try:
            with open(f"/proc/{name}/status") as file:
                status = dict(line.split(":", 1) for line in file if ":" in line)
            parents[int(name)] = (int(status["PPid"]), int(status.get("VmHWM", "0 kB").split()[0]))
        except (OSError, ValueError, KeyError):
            continue
    for pid, (_, peak) in parents.items():
        up = pid
        while up in parents and up != root:
            up = parents[up][0]
        if up == root:
            peaks[pid] = max(peaks.get(pid, 0), peak)


def run(command, ranks=1, cwd=None, limit=3600, watch_memory=False, threads=1):
    """Runs a command on pinned cores. Returns (standard output, peak resident MiB of all its processes or None)."""
    process = subprocess.Popen(pinned(command, ranks, threads), cwd=cwd, env=environment(ranks), text=True,
                               stdout=subprocess.PIPE, stderr=subprocess.STDOUT)
    peaks = {}

    def watch():
        while process.poll() is None:
            peak_of_tree(process.pid, peaks)
            time.sleep(0.1)

    if watch_memory:
        watcher = threading.Thread(target=watch, daemon=True)
        watcher.start()
    try:
        text, _ = process.communicate(timeout=limit)
    except subprocess.TimeoutExpired:
        process.terminate()
        text, _ = process.communicate()
        raise Failed(f"{' '.join(command)}\nran into the limit of {limit} s") from None
    if process.returncode != 0:
        raise Failed(f"{' '.join(command)}\nended with status {process.returncode}:\n{text[-2000:]}")
    return text, sum(peaks.values()) / 1024 if watch_memory else None


def run_barchan(barchan, deck, out, ranks=1, arguments=(), settings=None, watch_memory=False, threads=1):
    """One run of a deck. Returns its run.json, with `peak_mib` where memory was watched."""
    command = [barchan, "run", deck, "--out", out, "--force", "--quiet", "--threads", str(threads), *arguments]
    for key, value in (settings or {}).items():
        command += ["--set", f"{key}={value}"]
    _, peak = run(command, ranks, watch_memory=watch_memory, threads=threads)
    with open(os.path.join(out, "run.json")) as file:
        result = json.load(file)
    result["peak_mib"] = peak
    return result
