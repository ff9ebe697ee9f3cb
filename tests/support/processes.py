"""Processes below another one, from /proc: `ps` may not be installed."""
import os
import signal
import subprocess


def children_of(parent):
    """Process ids; under mpirun those of the ranks."""
    found = []
    for name in filter(str.isdigit, os.listdir("/proc")):
        try:
            with open(f"/proc/{name}/stat", encoding="utf-8", errors="replace") as file:
                state, ppid = file.read().rsplit(")", 1)[1].split()[:2]
        except OSError:  # has ended meanwhile
            continue
        if int(ppid) == parent and state != "Z":
            found.append(int(name))
    return sorted(found)


def rank_of(pid):
    """The rank that a process below Open MPI's mpirun is; -1 for others."""
    try:
        with open(f"/proc/{pid}/environ", "rb") as file:
            words = dict(entry.split(b"=", 1) for entry in file.read().split(b"\0") if b"=" in entry)
    except OSError:
        return -1
    return int(words.get(b"OMPI_COMM_WORLD_RANK", b"-1"))


def name_of(pid):
    """What a process runs: that of a rank is still its launcher's until it has begun. Empty: it has ended."""
    try:
        with open(f"/proc/{pid}/comm", encoding="utf-8", errors="replace") as file:
            return file.read().strip()
    except OSError:
        return ""


def is_there(pid):
    """Whether a process lives: it may have ended without having been waited for."""
    try:
        with open(f"/proc/{pid}/stat", encoding="utf-8", errors="replace") as file:
            return file.read().rsplit(")", 1)[1].split()[0] not in "ZX"
    except OSError:
        return False


def output_after_kill(process, seconds):
    """stdout and stderr of a run under mpirun of which a rank was killed. Open MPI's mpirun may hang for ever over a rank
    that was killed as it began; then all is ended."""
    try:
        return process.communicate(timeout=seconds)
    except subprocess.TimeoutExpired:
        for pid in children_of(process.pid) + [process.pid]:
            try:
                os.kill(pid, signal.SIGKILL)
            except ProcessLookupError:
                pass
        return process.communicate()
