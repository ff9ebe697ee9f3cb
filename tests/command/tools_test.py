"""check, info and convert say what is there; --help and --version work everywhere."""
import os

from _helper import DECK, expect, finish, fresh, messages, run, write


def check_help():
    for arguments in (["--help"], ["run", "--help"], ["check", "--help"], ["info", "--help"], ["convert", "--help"]):
        done = run(*arguments)
        expect(done.returncode == 0 and "Usage" in done.stdout, f"{arguments}: {done}")
    for arguments in (["--version"], ["run", "--version"], ["convert", "--version"]):
        done = run(*arguments)
        expect(done.returncode == 0 and done.stdout.startswith("barchan "), f"{arguments}: {done}")
    done = run("--version", ranks=2)
    expect(done.returncode == 0 and done.stdout.count("barchan ") == 1, f"--version on two ranks: {done.stdout}")


def check_check():
    write("case.toml", DECK)
    for ranks in (1, 2):
        done = run("check", "case.toml", ranks=ranks)
        expect(done.returncode == 0, f"check: {done.stderr}")
        for word in ("350 disks", "sand–sand", "Stable step", "at most", "Memory", "floor"):
            expect(done.stdout.count(word) >= 1, f"check: no '{word}' in {done.stdout}")
        expect(done.stdout.count("Stable step") == 1, "check printed more than once")
    done = run("check", "case.toml", "--set", "time.step=3e-3")
    expect("Warning" in done.stdout, f"check: no warning above a fifth: {done.stdout}")


def check_info():
    fresh("case.out")
    run("run", "case.toml", "--steps", "2", "--quiet", ranks=2)
    cases = [("case.out", "350"), ("case.out/run.json", "350"), ("case.out/series.csv", "rows"), ("case.toml", "a deck"),
             ("case.out/snapshots/run.pvd", "snapshots"), ("case.out/snapshots/step_000000002.pvtp", "350"),
             ("case.out/snapshots/step_000000002_rank_0.vtp", "a snapshot")]
    for path, word in cases:
        done = run("info", path)
        expect(done.returncode == 0 and word in done.stdout, f"info {path}: {done}")
    for path in ("nowhere", "snap.xyz", "."):
        write("snap.xyz", "x\n")
        done = run("info", path)
        expect(done.returncode == 2 and len(messages(done)) == 1, f"info {path}: {done}")


def check_convert():
    snapshot = "case.out/snapshots/step_000000002.pvtp"
    chain = [snapshot, "a.csv", "a.data", "b.csv", "b.vtp", "c.csv"]
    fresh(*chain[1:])
    for source, target in zip(chain, chain[1:]):
        done = run("convert", source, target)
        expect(done.returncode == 0 and "350 disks" in done.stdout, f"convert {source} {target}: {done}")
    with open("b.csv", encoding="utf-8") as one, open("c.csv", encoding="utf-8") as other:
        expect(one.read() == other.read(), "a way through .vtp changed the particles")
    done = run("convert", "a.csv", "b.csv")
    expect(done.returncode == 2 and "exists" in done.stderr, f"convert over a file: {done}")
    done = run("convert", "a.csv", "a.pdf")
    expect(done.returncode == 2 and not os.path.exists("a.pdf"), f"convert to a .pdf: {done}")


check_help()
check_check()
check_info()
check_convert()
finish()
