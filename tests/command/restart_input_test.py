"""A restart with other particles is refused and what differs is named; what does not alter the state may change; and what an
error advises for a restart works with the checkpoint that it names."""
import csv
import os
import shutil

from _faults import CHECKPOINTS, checkpoints_of, digest_of, log_of
from _helper import DECK, expect, finish, fresh, messages, run, write

SAVED = DECK.replace('material = "sand"\n\n[[wall]]', 'material = "sand"\njitter = 0.5\nspacing = 0.1\n\n[[wall]]') + CHECKPOINTS
LIST = '\n[[particles]]\nkind = "list"\nmaterial = "sand"\nparticle = [{ position = [0.5, 0.9], radius = 0.03 }]\n'
FILE = '\n[[particles]]\nkind = "file"\npath = "more.csv"\n'
ROWS = "id,type,radius,density,x,y,z,vx,vy,vz,omegax,omegay,omegaz\n1001,1,0.03,1000,1.5,0.9,0,{speed},0,0,0,0,0\n"
SHORT = ("--quiet", "--steps", "100")


def changed(old, new, text=SAVED + LIST + FILE):
    assert old in text, old
    return text.replace(old, new, 1)


def first_run():
    write("more.csv", ROWS.format(speed=0.1))
    write("saved.toml", SAVED + LIST + FILE)
    fresh("saved.out")
    done = run("run", "saved.toml", "--out", "saved.out", *SHORT)
    expect(done.returncode == 0, f"the run before: {done.stderr}")


def copy():
    fresh("copy.out")
    shutil.copytree("saved.out", "copy.out")
    return "copy.out"


def go_on(deck, *more, out, steps=160, ranks=1):
    write("other.toml", deck)
    return run("run", "other.toml", "--out", out, "--restart", "auto", "--quiet", "--steps", steps, *more, ranks=ranks)


def refused(name, done, *words):
    said = messages(done)
    expect(done.returncode == 2 and len(said) == 1, f"{name}: status {done.returncode}, {done.stderr}")
    for word in words:
        expect(word in "".join(said), f"{name}: no '{word}' in {said}")


def files_of(folder):
    return {os.path.join(root, name): os.stat(os.path.join(root, name)).st_mtime_ns
            for root, _, names in os.walk(folder) for name in names}


def check_other_particles():
    out = "saved.out"
    before = files_of(out)
    source = ("[[particles]] 1 (lattice, line 21)", "other particles")
    for old, new, words in (
            ("radius = 0.04", "radius = 0.039", ("radius was 0.04 and is 0.039", *source)),
            ("jitter = 0.5", "jitter = 0.5\nseed = 7", ("seed was not given and is 7", *source)),
            ("jitter = 0.5\n", "", ("jitter was 0.5 and is not given", *source)),
            ("jitter = 0.5", "jitter = 0.5\nvelocity = [0.1, 0.0]", ("velocity was not given and is [0.1, 0", *source)),
            ("jitter = 0.5", "jitter = 0.5\nfixed = true", ("fixed was not given and is true", *source)),
            ("hi = [4.0, 0.8]", "hi = [3.0, 0.8]", ("region.hi was [4, 0.8] and is [3, 0.8]", *source)),
            ("position = [0.5, 0.9]", "position = [0.6, 0.9]",
             ("[[particles]] 2 (list", "particle.1.position was [0.5, 0.9] and is [0.6, 0.9]")),
            (LIST, "", ("[[particles]] 2 (list) of the checkpoint is gone",)),
            (FILE, FILE + LIST.replace("0.5, 0.9", "2.5, 0.9"), ("[[particles]] 4 (list", "was added"))):
        refused(f"{old!r} became {new!r}", go_on(changed(old, new), out=out), *words)
    write("more.csv", ROWS.format(speed=0.2))
    refused("another file", go_on(SAVED + LIST + FILE, out=out, ranks=2), "[[particles]] 3 (file", "contents of \"more.csv\"")
    write("more.csv", ROWS.format(speed=0.1))
    expect(files_of(out) == before, "a refused restart changed the folder")


def check_remedies_of_other_particles():
    """The message offers the particles of that run, or another folder without --restart."""
    out = copy()
    done = go_on(SAVED + LIST + FILE, out=out)
    expect(done.returncode == 0, f"the particles of that run: {done.stderr}")
    fresh("new.out")
    write("other.toml", changed("radius = 0.04", "radius = 0.039"))
    done = run("run", "other.toml", "--out", "new.out", *SHORT)
    expect(done.returncode == 0, f"a run of its own: {done.stderr}")


def check_allowed():
    """Keys without effect, other words for the same number, and all that is no state: the same bits."""
    undisturbed = copy()
    expect(go_on(SAVED + LIST + FILE, out=undisturbed).returncode == 0, "undisturbed")
    expected = digest_of(undisturbed)
    cases = {
        "the same number in other words": changed("radius = 0.04", "radius = 4e-2"),
        "a seed that draws nothing": changed("kind = \"list\"", "kind = \"list\"  # a comment"),
        "limits": SAVED + LIST + FILE + "\n[limits]\noverlap_warning = 0.4\n",
        "outside": changed("hi = [4.0, 1.0]", 'hi = [4.0, 1.0]\noutside = "delete"'),
        "outputs": SAVED + LIST + FILE + "\n[output]\npicture = false\nsnapshots_every = 30\n",
        "names": changed('name = "floor"', 'name = "ground"'),
        "keep": changed("keep = 3", "keep = 5"),
    }
    for name, deck in cases.items():
        done = go_on(deck, "--exchange", "isend", "--threads", "2", out=copy(), ranks=2)
        expect(done.returncode == 0, f"{name}: {done.stderr}")
        expect(done.returncode or digest_of("copy.out") == expected, f"{name}: another digest")
        if name == "names":  # its columns are named after the wall
            expect("series_1.csv" in done.stderr, f"{name}: {done.stderr}")
            check_second_series("copy.out")


def check_second_series(out):
    with open(f"{out}/series_1.csv", encoding="utf-8") as file:
        former = list(csv.DictReader(file))
    with open(f"{out}/series.csv", encoding="utf-8") as file:
        rows = list(csv.DictReader(file))
    expect("floor_force_y" in former[0] and "ground_force_y" in rows[0], "the columns of two series")
    expect(int(former[-1]["step"]) < int(rows[0]["step"]) == 100 and rows[-1]["step"] == "160",
           f"rows to {former[-1]['step']}, then from {rows[0]['step']} to {rows[-1]['step']}")


first_run()
check_other_particles()
check_remedies_of_other_particles()
check_allowed()
finish()
