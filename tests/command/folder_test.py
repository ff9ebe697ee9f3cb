"""A run holds its folder alone, and removes only what runs wrote: two runs at once, locks of the dead, files of others."""
import os
import shutil
import signal
import socket
import subprocess

from _faults import CHECKPOINTS, LONG, begin, checkpoints_of, ended, has_rows, log_of, wait_for
from _helper import COMMAND, DECK, command_line, expect, finish, fresh, messages, run, timed, write

SHORT = ("--quiet", "--steps", "100")
LOCK = "run.lock"


def files_of(folder):
    """Every file with its contents."""
    found = {}
    for root, _, names in os.walk(folder):
        for name in names:
            with open(os.path.join(root, name), "rb") as file:
                found[os.path.relpath(os.path.join(root, name), folder)] = file.read()
    return found


def holder_of(out):
    with open(f"{out}/{LOCK}", encoding="utf-8") as file:
        return int(file.read().split("pid ")[1].split()[0])


def refused(name, done, *words):
    said = messages(done)
    expect(done.returncode == 2 and len(said) == 1, f"{name}: status {done.returncode}, {done.stderr}")
    for word in words:
        expect(word in "".join(said), f"{name}: no '{word}' in {said}")


def check_held(ranks):
    """A second run of a folder is told who holds it, however it would begin; the first one does not notice."""
    out = "held.out"
    fresh(out)
    first = begin("run", "saved.toml", "--out", out, *LONG, ranks=ranks)
    wait_for(lambda: has_rows(out), "rows")
    pid = str(holder_of(out))
    for more in ((), ("--force",), ("--restart", "auto"), ("--restart", out + "/checkpoints", "--force")):
        refused(f"held folder {more}", run("run", "saved.toml", "--out", out, *SHORT, *more),
                "another run is writing into this folder", f"process {pid}", socket.gethostname())
    refused("held folder, two ranks", run("run", "saved.toml", "--out", out + "/", *SHORT, "--force", ranks=2), pid)
    expect(first.poll() is None and has_rows(out), "the first run was disturbed")
    os.kill(int(pid), signal.SIGTERM)
    done = ended(first)
    expect(done.returncode == 0 and not messages(done), f"the first run: {done.returncode}, {done.stderr}")
    expect(not os.path.exists(f"{out}/{LOCK}"), "the lock is left")


def check_stale():
    """A lock of a process that was killed, or of no process at all, is taken over, and the log says so."""
    out = "stale.out"
    fresh(out)
    first = begin("run", "saved.toml", "--out", out, *LONG)
    wait_for(lambda: checkpoints_of(out), "a checkpoint")
    first.kill()
    ended(first)
    expect(os.path.exists(f"{out}/{LOCK}"), "killed, and no lock is left to be taken over")
    done = run("run", "saved.toml", "--out", out, "--force", *SHORT, ranks=2)
    expect(done.returncode == 0, f"stale lock: {done.stderr}")
    expect(f"process {first.pid} on" in log_of(out) and "died" in log_of(out), f"stale lock: {log_of(out)}")
    for text in ("", "host elsewhere\npid 1\nstarted 5\nsince long ago\n", "nonsense " * 400):
        write(f"{out}/{LOCK}", text)
        done = run("run", "saved.toml", "--out", out, "--force", *SHORT)
        expect(done.returncode == 0 and not os.path.exists(f"{out}/{LOCK}"), f"lock {text[:20]!r}: {done.stderr}")
    fresh("new.out")
    os.mkdir("new.out")
    write(f"new.out/{LOCK}", "")  # of a run that died before its first result
    done = run("run", "saved.toml", "--out", "new.out", *SHORT)
    expect(done.returncode == 0, f"a folder with a stale lock alone: {done.stderr}")


def check_race(ranks, *more):
    """Runs that are started together: one wins, the others end with status 2, and nothing is mixed."""
    out, name = "race/deep/er.out", f"race, {ranks} ranks {more}"
    fresh("race")
    if more:
        expect(run("run", "saved.toml", "--out", out, *SHORT).returncode == 0, f"before the {name}")
    runs = [begin("run", "saved.toml", "--out", out, *LONG, *more, ranks=ranks) for _ in range(3)]
    wait_for(lambda: sum(process.poll() is not None for process in runs) == 2, f"{name}: two of three to be refused")
    wait_for(lambda: has_rows(out, 10), f"{name}: rows of the winner")
    if os.path.exists(f"{out}/{LOCK}"):
        os.kill(holder_of(out), signal.SIGTERM)
    done = [ended(process) for process in runs]
    expect(sorted(d.returncode for d in done) == [0, 2, 2], f"{name}: {[(d.returncode, d.stderr) for d in done]}")
    for d in done:
        expect(d.returncode == 0 or "another run is writing" in d.stderr, f"{name}: {d.stderr}")
    with open(f"{out}/series.csv", encoding="utf-8") as file:
        steps = [int(line.split(",")[0]) for line in file.readlines()[1:]]
    expect(steps == sorted(set(steps)), f"{name}: rows are mixed: {steps[:40]}")
    expect(not os.path.exists(f"{out}/{LOCK}"), f"{name}: a lock is left")


def check_nothing_made():
    """What is refused after the folder was claimed leaves no folder."""
    fresh("deep")
    refused("bad deck", run("run", "bad.toml", "--out", "deep/er/run.out", *SHORT), "bad.toml")
    refused("unstable", run("run", "saved.toml", "--out", "deep/er/run.out", "--set", "time.step=1"), "unstable")
    expect(not os.path.exists("deep"), "a refused run made folders")


def whole_run(out):
    fresh(out)
    done = run("run", "saved.toml", "--out", out, *SHORT, "--trace")
    expect(done.returncode == 0, f"{out}: {done.stderr}")


def check_foreign_files_stay():
    out = "mine.out"
    mine = {"notes.txt": "n", "plot.png": "p", "snapshots/export.vtp": "v", "snapshots/step_5.vtp": "v",
            "snapshots/step_000000100_mine.vtp": "v", "checkpoints/notes.txt": "c", "checkpoints/step_mine.part": "c",
            "checkpoints/step_000000050_backup/rank_00000.bin": "c", "series_mine.csv": "s", "data/run.json": "d"}
    for more in (("--force",), ("--restart", "auto"), ("--restart", "auto", "--steps", "200")):
        whole_run(out)
        for name, text in mine.items():
            os.makedirs(os.path.dirname(f"{out}/{name}") or ".", exist_ok=True)
            write(f"{out}/{name}", text)
        done = run("run", "saved.toml", "--out", out, "--quiet", *(more if "--steps" in more else (*more, "--steps", "100")))
        expect(done.returncode == 0, f"{more}: {done.stderr}")
        there = files_of(out)
        for name, text in mine.items():
            expect(there.get(name) == text.encode(), f"{more}: {name} is gone or changed")
    write(f"{out}/run.json.tmp123", "{\n")
    write(f"{out}/snapshots/run.pvd.tmp123", "")
    done = run("run", "saved.toml", "--out", out, "--force", *SHORT)
    expect(not any("tmp" in name for name in files_of(out)), f"unfinished results stay: {sorted(files_of(out))}")


def check_foreign_files_in_the_way():
    """Nothing at all is removed; the file is named; both remedies work."""
    whole_run("whole.out")
    for name in ("run.json", "log.txt", "series.csv", "picture.png", "trace.json", "left_domain.csv",
                 "snapshots/step_000000000.pvtp", "checkpoints/step_000000050/notes.txt",
                 "checkpoints/step_000000075.part/mine.bin", "checkpoints/step_000000075", "snapshots/run.pvd/deep"):
        out = "way.out"
        fresh(out)
        shutil.copytree("whole.out", out)
        fresh(f"{out}/{name}", f"{out}/{os.path.dirname(name)}" if name.endswith("deep") else "none")
        os.makedirs(os.path.dirname(f"{out}/{name}"), exist_ok=True)
        write(f"{out}/{name}", "mine\n")
        before = files_of(out)
        for more in (("--force",), ("--restart", "auto")):
            refused(f"{name}, {more}", run("run", "saved.toml", "--out", out, "--quiet", "--steps", "150", *more),
                    os.path.dirname(name) if name.endswith("deep") else name, "nothing was removed")
            expect(files_of(out) == before, f"{name}, {more}: {sorted(set(before) ^ set(files_of(out)))}")
    os.remove(f"{out}/snapshots/run.pvd/deep")
    os.rename(f"{out}/snapshots/run.pvd", f"{out}/moved")
    done = run("run", "saved.toml", "--out", out, "--force", *SHORT)
    expect(done.returncode == 0, f"moved away: {done.stderr}")
    fresh("new.out")
    done = run("run", "saved.toml", "--out", "new.out", *SHORT)
    expect(done.returncode == 0, f"another folder: {done.stderr}")


def check_foreign_folder():
    """A folder that is no run's, with files that have the names of results."""
    fresh("project")
    os.mkdir("project")
    write("project/log.txt", "my diary\n")
    write("project/run.json", '{"name": "my configuration"}\n')
    before = files_of("project")
    for more in ((), ("--force",), ("--restart", "auto")):
        refused(f"foreign folder {more}", run("run", "saved.toml", "--out", "project", *SHORT, *more), "project")
        expect(files_of("project") == before, f"foreign folder {more}: changed")


def check_empty_words():
    for option in ("--out", "--restart", "--exchange", "--record", "--graph", "--vector"):
        for words in ((option, ""), (option + "=",)):
            fresh("saved.out")
            refused(f"{words}", run("run", "saved.toml", *SHORT, *words), option)
            expect(not os.path.exists("saved.out"), f"{words}: a folder was made")
    for words in (("run", ""), ("check", ""), ("info", ""), ("convert", "", "a.csv"), ("convert", "a.csv", "")):
        refused(f"{words}", run(*words), "is empty")


def check_launchers():
    """Processes that take themselves for the only ones are refused, and one of them says so."""
    fresh("alone.out")
    for variables in ({"PMI_SIZE": "2", "PMI_RANK": "0"}, {"OMPI_COMM_WORLD_SIZE": "2", "OMPI_COMM_WORLD_RANK": "1"},
                      {"SLURM_NTASKS": "4", "SLURM_STEP_NUM_TASKS": "4", "SLURM_PROCID": "0"},
                      {"SLURM_NTASKS": "4", "SLURM_PROCID": "3"}):
        line = command_line(("run", "saved.toml", "--out", "alone.out", *SHORT), 1)
        done = subprocess.run(line, env={**os.environ, **variables}, capture_output=True, text=True, timeout=60)
        is_first = "0" in (variables.get("PMI_RANK"), variables.get("SLURM_PROCID"))
        if is_first:
            refused(f"{variables}", done, "a launcher started", "unset")
        else:
            expect(done.returncode == 2 and not messages(done), f"{variables}: {done}")
        expect(not os.path.exists("alone.out"), f"{variables}: a folder was made")
    for variables in ({"PMI_SIZE": "1"}, {"SLURM_NTASKS": "4", "SLURM_PROCID": "0"}):
        fresh("alone.out")
        line = command_line(("run", "saved.toml", "--out", "alone.out", *SHORT), 1)
        done = subprocess.run(line, env={**os.environ, **variables}, capture_output=True, text=True, timeout=60)
        expect(done.returncode == 0, f"{variables}: {done.stderr}")
    done = subprocess.run(["mpirun", "-n", "2", "-x", "SLURM_STEP_NUM_TASKS=4", COMMAND, "run", "saved.toml", "--out",
                           "alone.out", "--force", *SHORT], capture_output=True, text=True, timeout=60)
    expect(done.returncode == 0, f"mpirun within srun: {done.stderr}")


write("saved.toml", DECK + CHECKPOINTS)
write("bad.toml", DECK + "\nnonsense = 1\n")
for num_ranks in (1, 2):
    timed(check_held, num_ranks)
timed(check_stale)
timed(check_race, 1)
timed(check_race, 2)
timed(check_race, 1, "--force")
timed(check_race, 1, "--restart", "auto")
for check in (check_nothing_made, check_foreign_files_stay, check_foreign_files_in_the_way, check_foreign_folder, check_empty_words,
              check_launchers):
    timed(check)
finish()
