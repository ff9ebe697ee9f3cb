"""Wrong input ends with status 2 and one message, on one rank and on two, and nothing is written."""
import os

from _helper import DECK, edited, expect, finish, fresh, messages, run, write

HEADER = "id,type,radius,density,x,y,z,vx,vy,vz,omegax,omegay,omegaz\n"
ROW = "{id},1,0.04,1000,{x},0.5,0,0,0,0,0,0,0\n"
LATTICE = DECK[DECK.index("[[particles]]"):DECK.index("[[wall]]")]


def from_file(path):
    source = f'[[particles]]\nkind = "file"\npath = "{path}"\nmaterial = "sand"\n\n'
    return edited((LATTICE, source))


def list_of(x):
    source = ('[[particles]]\nkind = "list"\nmaterial = "sand"\n'
              f'particle = [{{ position = [{x}, 0.5], radius = 0.04 }}]\n\n')
    return edited((LATTICE, source))


SECOND_MATERIAL = '[[material]]\nname = "clay"\ndensity = 900.0\n\n[[particles]]'
SAND_REGION = "region = { lo = [0.0, 0.2], hi = [4.0, 0.8] }"
SECOND_LATTICE = LATTICE.replace(SAND_REGION, "region = { lo = [1.0, 0.5], hi = [2.0, 0.9] }")

# name, deck, words of the message, further arguments
CASES = [
    ("unknown key", edited(("restitution", "restitutoin")),
     ["bad.toml:18:", "restitutoin", "did you mean 'restitution'"], []),
    ("unknown table", edited(("[time]", "[tiem]")), ["tiem", "time"], []),
    ("wrong type", edited(("density = 1000.0", 'density = "heavy"')),
     ["bad.toml:15:", "density", "number"], []),
    ("no deck at all", None, ["missing.toml"], []),
    ("no TOML", "dimension = = 2\n", ["bad.toml:1:"], []),
    ("negative density", edited(("density = 1000.0", "density = -1.0")),
     ["bad.toml:15:", "density"], []),
    ("negative radius", edited(("radius = 0.04", "radius = -0.04")), ["radius"], []),
    ("missing pair", edited(("[[particles]]", SECOND_MATERIAL), ('material = "sand"\n\n[[wall]]',
                                                                 'material = "clay"\n\n[[wall]]')),
     ["missing material pair", "clay", "[[pair]]"], []),
    ("overlapping regions", edited(("[[wall]]", SECOND_LATTICE + "[[wall]]")), ["overlap"], []),
    ("missing particle file", from_file("nowhere.csv"), ["nowhere.csv"], []),
    ("malformed particle file", from_file("malformed.csv"), ["malformed.csv:3:", "wide"], []),
    ("NaN coordinates", from_file("nan.csv"), ["nan.csv:2:", "nan"], []),
    ("particle outside the domain", from_file("outside.csv"), ["outside.csv:3", "outside the domain"], []),
    ("listed particle outside", list_of(4.5), ["outside the domain"], []),
    ("unstable step", edited(("step = 1e-4", "step = 0.05")),
     ["bad.toml", "time.step", "allow_unstable", "use at most"], []),
    ("bad override", DECK, ["time.stepp", "did you mean 'step'"], ["--set", "time.stepp=1"]),
    ("override without value", DECK, ["--set", "="], ["--set", "time.step"]),
    ("unknown exchange", DECK, ["put-falg", "put-flag"], ["--exchange", "put-falg"]),
    ("misspelt option", DECK, ["--stesp", "--steps"], ["--stesp", "3"]),
    ("negative steps", DECK, ["steps"], ["--steps", "-3"]),
]


def write_files():
    write("malformed.csv", HEADER + ROW.format(id=1, x=1.0) + ROW.format(id=2, x="wide"))
    write("nan.csv", HEADER + ROW.format(id=1, x="nan"))
    write("outside.csv", HEADER + ROW.format(id=1, x=1.0) + ROW.format(id=2, x=7.0))


def refused(name, done, words):
    said = messages(done)
    expect(done.returncode == 2, f"{name}: status {done.returncode}, stderr: {done.stderr}")
    expect(len(said) == 1, f"{name}: not one message: {done.stderr}")
    for word in words:
        expect(word in "".join(said), f"{name}: no '{word}' in: {said}")
    expect(done.stdout == "", f"{name}: words on stdout: {done.stdout}")


def check_decks(ranks):
    for name, text, words, more in CASES:
        fresh("bad.out", "bad.toml")
        if text is not None:
            write("bad.toml", text)
        deck = "bad.toml" if text is not None else "missing.toml"
        refused(f"{name}, {ranks} ranks", run("run", deck, *more, ranks=ranks), words)
        expect(not os.path.exists("bad.out"), f"{name}, {ranks} ranks: an output folder is left")


def check_folders(ranks):
    write("good.toml", DECK)
    fresh("there.out", "blocking")
    os.mkdir("there.out")
    write("there.out/run.json", '{\n "state_digest": "mine"}\n')
    write("blocking", "a file\n")
    short = ["run", "good.toml", "--steps", "2", "--quiet"]
    refused(f"existing folder, {ranks} ranks", run(*short, "--out", "there.out", ranks=ranks),
            ["there.out", "already exists", "--force"])
    with open("there.out/run.json", encoding="utf-8") as file:
        expect("mine" in file.read(), "a refused folder was touched")
    refused(f"unwritable folder, {ranks} ranks",
            run(*short, "--out", "blocking/run.out", ranks=ranks), ["blocking", "is a file"])
    refused(f"folder that is a file, {ranks} ranks", run(*short, "--out", "blocking", ranks=ranks),
            ["blocking", "is a file"])
    done = run(*short, "--out", "there.out", "--force", ranks=ranks)
    expect(done.returncode == 0, f"--force, {ranks} ranks: {done.stderr}")
    with open("there.out/run.json", encoding="utf-8") as file:
        expect("mine" not in file.read(), "--force did not replace the results")
    fresh("there.out")


def check_ranks():
    write("narrow.toml", edited(("hi = [4.0, 1.0]", "hi = [1.0, 1.0]"), ("hi = [4.0, 0.8]", "hi = [1.0, 0.8]"),
                                ("radius = 0.04", "radius = 0.12")))
    told = run("check", "narrow.toml")
    expect(told.returncode == 0, f"check: {told.stderr}")
    most = int(told.stdout.split("fit as strips, ")[1].split()[0])
    refused("more ranks than bricks", run("run", "narrow.toml", "--quiet", ranks=most + 1),
            [f"{most + 1} ranks", f"at most {most}"])
    expect(not os.path.exists("narrow.out"), "more ranks than bricks: an output folder is left")
    refused("check of more ranks than bricks", run_check_ranks(most + 1), [f"at most {most}"])


def run_check_ranks(ranks):
    done = run("check", "narrow.toml", "--ranks", ranks)
    done.stdout = ""
    return done


def check_unstable():
    write("unstable.toml", edited(("step = 1e-4", "step = 0.05"), ("steps = 200", "steps = 1")))
    done = run("check", "unstable.toml")
    expect(done.returncode == 2 and "Stable step" in done.stdout, f"check of an unstable deck: {done.stderr}")
    fresh("unstable.out")
    done = run("run", "unstable.toml", "--quiet", "--set", "time.allow_unstable=true")
    expect(done.returncode != 2, f"allow_unstable did not allow: {done.stderr}")


def check_failure(ranks):
    """A run that goes wrong ends with status 1, everywhere and with one message."""
    write("open.toml", edited(("[[wall]]", LATTICE.replace('material = "sand"', 'material = "sand"\nvelocity = [0.0, 9.0]')
                               .replace(SAND_REGION, "region = { lo = [3.0, 0.85], hi = [3.2, 1.0] }") + "[[wall]]"),
                              ("steps = 200", "steps = 20000")))
    fresh("open.out")
    done = run("run", "open.toml", "--quiet", ranks=ranks)
    said = messages(done)
    expect(done.returncode == 1 and len(said) == 1, f"a particle that leaves, {ranks} ranks: {done}")
    expect("domain" in "".join(said), f"a particle that leaves, {ranks} ranks: {said}")
    expect(not os.path.exists("open.out/run.json"), "a failed run left a run.json")


write_files()
for num_ranks in (1, 2):
    check_decks(num_ranks)
    check_folders(num_ranks)
    check_failure(num_ranks)
check_ranks()
check_unstable()
finish()
