"""check, info and convert say what is there; --help and --version work everywhere."""
import os

from _helper import DECK, expect, finish, fresh, messages, run, write


def check_help():
    for arguments in (["--help"], ["run", "--help"], ["check", "--help"], ["info", "--help"], ["convert", "--help"],
                      ["sweep", "--help"], ["report", "--help"], ["watch", "--help"], ["table", "--help"], ["compare", "--help"]):
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
        for word in ("350 disks", "sand–sand", "Stable step", "at most", "Memory", "floor", " 5.027 ", " 1759"):
            expect(done.stdout.count(word) >= 1, f"check: no '{word}' in {done.stdout}")
        expect(done.stdout.count("Stable step") == 1, "check printed more than once")
    done = run("check", "case.toml", "--set", "time.step=3e-3")
    expect("Warning" in done.stdout, f"check: no warning above a fifth: {done.stdout}")


def check_restitutions():
    glass = '[[material]]\nname = "glass"\ndensity = 2000.0\nnormal_stiffness = 1e5\nrestitution = 0.18\n'
    steel = '[[material]]\nname = "steel"\ndensity = 7000.0\nnormal_stiffness = 1e5\nnormal_damping = 300.0\n'
    own = '[[pair]]\nmaterials = ["sand", "steel"]\nnormal_stiffness = 1e5\n'
    own += '[[pair]]\nmaterials = ["glass", "steel"]\nnormal_stiffness = 1e5\nrestitution = 0.75\n'
    ball = '[[particles]]\nkind = "list"\nmaterial = "{}"\nparticle = [{{ position = [{}, 0.9], radius = 0.04 }}]\n'
    write("pairs.toml", DECK + glass + steel + own + ball.format("glass", 1.0) + ball.format("steel", 2.0))
    done = run("check", "pairs.toml")
    expect(done.returncode == 0, f"check: {done.stderr}")
    lines = {line.split()[0]: " ".join(line.split()[1:]) for line in done.stdout.splitlines() if "–" in line}
    for pair, text in [("sand–sand", " 0.5"), ("sand–glass", " 0.3, mixed"), ("sand–steel", " 1, of the dashpot"),
                       ("glass–steel", " 0.75"), ("steel–steel", " 0.7176, of the dashpot")]:
        expect(lines.get(pair, "").endswith(text), f"{pair}: no '{text}' in {done.stdout}")
    expect("Warning: restitution 1, head-on collisions lose no energy: sand–steel\n" in done.stdout, done.stdout)


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
check_restitutions()
check_info()
check_convert()
finish()
