"""What a result was measured on: processor, caches, flags, compiler, commit, load. No host names, no dates."""
import os
import re
import resource
import subprocess
import time

SOURCE = os.path.dirname(os.path.dirname(os.path.dirname(os.path.abspath(__file__))))
FLAGS = ("sse2", "avx", "avx2", "fma", "avx512f", "avx512dq", "avx512vl", "avx512bw")


def output_of(command):
    """Standard output of a command; empty where there is no such command or it fails."""
    try:
        done = subprocess.run(command, stdout=subprocess.PIPE, stderr=subprocess.DEVNULL, text=True)
    except OSError:
        return ""
    return done.stdout.strip() if done.returncode == 0 else ""


def lscpu():
    fields = {}
    for line in output_of(["lscpu"]).splitlines():
        name, _, value = line.partition(":")
        fields[name.strip()] = value.strip()
    return fields


def num_cores():
    """Cores that this process may use."""
    return len(os.sched_getaffinity(0))


def memory_gib():
    with open("/proc/meminfo") as file:
        return round(int(file.readline().split()[1]) / 2**20, 1)


def commit():
    """Short hash of the sources, with '+' where those of the program differ from it."""
    git = ["git", "-C", SOURCE]
    name = output_of([*git, "rev-parse", "--short=12", "HEAD"]) or "unknown"
    parts = ["core", "comm", "tasks", "app", "cmake", "CMakeLists.txt"]
    changed = output_of([*git, "status", "--porcelain", "--", *parts])
    return name + ("+" if changed else "")


def describe():
    cpu = lscpu()
    have = cpu.get("Flags", "").split()
    caches = {name: cpu[f"{name} cache"] for name in ("L1d", "L1i", "L2", "L3") if f"{name} cache" in cpu}
    return {
        "processor": cpu.get("Model name", "unknown"),
        "family": cpu.get("CPU family", ""),
        "model": cpu.get("Model", ""),
        "cores": num_cores(),
        "virtual": cpu.get("Hypervisor vendor", "") or "no",
        "caches": caches,
        "flags": [flag for flag in FLAGS if flag in have],
        "memory_gib": memory_gib(),
        "compiler": output_of(["c++", "--version"]).splitlines()[0] if output_of(["c++", "--version"]) else "",
        "mpi": (output_of(["mpirun", "--version"]).splitlines() or [""])[0],
    }


def slug():
    """A folder's name for results of machines of this kind, such as amd-epyc-f26-m2-2-cores."""
    machine = describe()
    text = f"{machine['processor']} f{machine['family']} m{machine['model']} {machine['cores']} cores"
    return re.sub(r"[^a-z0-9]+", "-", text.lower()).strip("-")


def busy_seconds():
    """Time that all cores of the machine have worked since it started [s]."""
    with open("/proc/stat") as file:
        user, nice, system, _, _, irq, softirq = (int(word) for word in file.readline().split()[1:8])
    return (user + nice + system + irq + softirq) / os.sysconf("SC_CLK_TCK")


class OtherWork:
    """Cores that processes other than this one and its children have used while it lived, in the mean.

    A child counts when it has ended and been waited for. Ticks of the clock make it rough below a second.
    """

    def __init__(self):
        self.begin = self.now()

    @staticmethod
    def now():
        own = sum(usage.ru_utime + usage.ru_stime for usage in
                  (resource.getrusage(resource.RUSAGE_SELF), resource.getrusage(resource.RUSAGE_CHILDREN)))
        return time.monotonic(), busy_seconds(), own

    def cores(self):
        seconds, busy, own = (after - before for after, before in zip(self.now(), self.begin))
        return max(0.0, busy - own) / seconds if seconds > 0 else 0.0


WHOLE = OtherWork()  # while a script ran


def load_of_others():
    """Cores that others have used since the script began; above 0.2 figures are rough."""
    return WHOLE.cores()
