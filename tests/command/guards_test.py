"""Particles that are too fast for their step or for the lists, and decks too far from the origin: a contact, an error that names
both, in the same words on any number of ranks, and remedies that work."""
import re

from _faults import digest_of, expect_failure
from _helper import expect, finish, fresh, messages, replaced, run, write

SHOT = """
dimension = 2
[domain]
lo = [0.0, 0.0]
hi = [3.0, 3.0]
[time]
step = 1e-4
steps = 300
[[material]]
name = "m"
density = 1000.0
normal_stiffness = 1e3
[[particles]]
kind = "list"
material = "m"
particle = [ { position = [0.3033, 1.5], radius = 0.001, velocity = [60.0, 0.0] }, { position = [2.7, 2.7], radius = 0.2 } ]
[[wall]]
name = "shield"
kind = "plate"
point = [1.0, 1.5]
normal = [-1.0, 0.0]
width = 1.0
material = "m"
[output]
picture = false
"""

FALL = """
dimension = 2
gravity = [0.0, -9.81]
[domain]
lo = [0.0, -0.1]
hi = [1.0, 3.0]
outside = "delete"
[time]
step = 1e-3
steps = 1000
[[material]]
name = "m"
density = 1000.0
normal_stiffness = 1e5
restitution = 0.5
[[particles]]
kind = "lattice"
region = { lo = [0.0, 0.0], hi = [1.0, 0.4] }
radius = 0.05
material = "m"
[[particles]]
kind = "list"
material = "m"
particle = [ { position = [0.5, 2.5], radius = 0.05 } ]
[[wall]]
name = "floor"
point = [0.0, 0.0]
normal = [0.0, 1.0]
material = "m"
[checkpoint]
every_steps = 100
[output]
picture = false
"""


def errors_of(done):
    return [line for line in messages(done) if "warning" not in line]


def expect_same_words(name, deck, *parts, ways=((1, 1), (1, 2), (3, 1))):
    write("case.toml", deck)
    said = set()
    for ranks, threads in ways:
        fresh("case.out")
        done = run("run", "case.toml", "--quiet", "--threads", threads, ranks=ranks)
        expect_failure(f"{name}, {ranks} ranks", done, *parts)
        said.add(str(errors_of(done)))
    expect(len(said) == 1, f"{name}: not the same words: {said}")
    return said.pop()


def check_shots():
    told = expect_same_words("shot at a plate", SHOT, "particle 1 at", "has passed wall 'shield'")
    second = "velocity = [60.0, 0.0] }, { position = [2.7, 1.5], radius = 0.001, velocity = [-30.0, 0.0] }"
    pair = replaced(SHOT[:SHOT.index("[[wall]]")], ("velocity = [60.0, 0.0] }", second))
    expect_same_words("shots at each other", pair, "particle 1 at", "has passed particle 2 at")
    around = replaced(pair, ("hi = [3.0, 3.0]", 'hi = [3.0, 3.0]\nperiodic = ["x"]'), ("[60.0", "[-60.0"), ("[-30.0", "[30.0"))
    expect_same_words("shots around the box", around, "particle 1 at", "has passed particle 2 at")

    end = replaced(SHOT, ("[0.3033, 1.5]", "[1.0003, 0.3]"), ("velocity = [60.0, 0.0]", "velocity = [0.0, 60.0]"))
    expect_same_words("shot at the end of a plate", end, "particle 1 at", "has passed wall 'shield'", "more than the smaller radius")

    several = "".join(f'{{ position = [{x}, {y}], radius = 0.001, velocity = [{v}, 0.0] }}, '
                      for x, y, v in ((2.3, 1.5, 60.0), (2.3637, 1.5, -30.0), (0.3, 1.0, 60.0), (0.3637, 1.0, -30.0)))
    both = replaced(pair, ("particle = [ ", "particle = [ " + several))
    expect_same_words("shots in two strips", both, "particle 1 at", "has passed particle 2 at")

    expect_held("more than the smaller radius", told, SHOT, 0.02)
    soft = replaced(SHOT, ("step = 1e-4", "step = 1e-6"), ("steps = 300", "steps = 13000"), ("normal_stiffness = 1e3", "normal_stiffness = 1e7"))
    expect_held("too soft", expect_same_words("a soft contact", soft, "has passed wall 'shield'", "too soft"), soft, 0.02)


def expect_held(name, told, deck, end):
    """The remedy of the message makes the shot rebound."""
    remedy = dict(re.findall(r"(normal_stiffness|time\.step) = ([0-9.e+-]+)", told))
    stiffness, step = (re.search(rf"\n{key} = (\S+)", deck) for key in ("normal_stiffness", "step"))
    length = float(remedy.get("time.step", step.group(1)))
    expect(length <= float(step.group(1)), f"{name}: a longer step as a remedy: {told}")
    write("held.toml", replaced(deck, (stiffness.group(0), f"\nnormal_stiffness = {float(remedy['normal_stiffness'])}"),
                               (step.group(0), f"\nstep = {length}"), (re.search("steps = .*", deck).group(0), f"steps = {int(end / length)}")))
    fresh("held.out")
    done = run("run", "held.toml", "--quiet")
    expect(done.returncode == 0, f"{name}: the remedy does not hold them apart: {done.stderr}")
    with open("held.out/series.csv", encoding="utf-8") as file:
        rows = [line.split(",") for line in file.read().splitlines()]
    expect(float(rows[-1][rows[0].index("momentum_x")]) < 0.0, f"no rebound: {rows[-1]}")


def check_warnings():
    write("case.toml", SHOT)
    done = run("check", "case.toml")
    expect(done.returncode == 0 and "Warning: particle 1 starts at 60 m/s" in done.stdout, f"check of a shot: {done.stdout}")
    step = re.search(r"time\.step = ([0-9.e+-]+) or less", done.stdout)
    done = run("check", "case.toml", "--set", f"time.step={step.group(1)}")
    expect("particle 1 starts at" not in done.stdout, f"check with the step it names: {done.stdout}")
    write("case.toml", replaced(FALL, ("hi = [1.0, 3.0]", "hi = [1.0, 300.0]"), ("[0.5, 2.5]", "[0.5, 299.0]")))
    done = run("check", "case.toml")
    expect("Warning: particle 41, if it falls" in done.stdout, f"check of a fall: {done.stdout}")


def check_fall():
    """The lists of a default skin last for a step or two when the ball arrives."""
    write("fall.toml", FALL)
    digests = set()
    for ranks in (1, 3):
        fresh("fall.out")
        done = run("run", "fall.toml", "--quiet", ranks=ranks)
        expect(done.returncode == 0, f"fall on {ranks} ranks: {done.stderr}")
        digests.add(digest_of("fall.out"))
    for steps in (620, 641):
        fresh("fall.out")
        run("run", "fall.toml", "--quiet", "--steps", steps)
        done = run("run", "fall.toml", "--quiet", "--restart", "auto", ranks=2)
        expect(done.returncode == 0, f"fall from step {steps}: {done.stderr}")
        digests.add(digest_of("fall.out"))
    expect(len(digests) == 1, f"fall: {digests}")


def check_too_fast():
    """A ball that leaves the domain by 0.7 radii a step: the default skin allows for it; of a narrow one the error names a remedy."""
    deck = replaced(FALL, ("radius = 0.05 } ]", "radius = 0.05, velocity = [0.0, 35.0] } ]"), ("steps = 1000", "steps = 40"))
    write("case.toml", deck)
    digests = set()
    for ranks in (1, 3):
        fresh("case.out")
        done = run("run", "case.toml", "--quiet", ranks=ranks)
        expect(done.returncode == 0, f"a ball that flies away on {ranks} ranks: {done.stderr}")
        digests.add(digest_of("case.out"))
    told = expect_same_words("too fast", deck + "[search]\nskin = 0.01\n", "particle 41 at", "search.skin = ")
    skin = re.search(r"search\.skin = ([0-9.e+-]+)", told).group(1)
    fresh("case.out")
    done = run("run", "case.toml", "--quiet", "--set", f"search.skin={skin}")
    expect(done.returncode == 0, f"with search.skin = {skin}: {done.stderr}")
    digests.add(digest_of("case.out"))
    expect(len(digests) == 1, f"a ball that flies away: {digests}")


def check_far_away():
    far = replaced(SHOT[:SHOT.index("[[wall]]")], ("lo = [0.0, 0.0]", "lo = [5e6, 0.0]"), ("hi = [3.0", "hi = [5000003.0"),
                  ("[0.3033, ", "[5000000.3, "), ("[2.7, ", "[5000002.7, "), ("[60.0", "[4e-6"))
    write("far.toml", far)
    for ranks in (1, 2):
        fresh("far.out")
        done = run("run", "far.toml", "--quiet", ranks=ranks)
        expect_failure("far away", done, "far.toml:3:", "9.3e-10 m apart", "4e-10 m a step", "subtract (5000002, 0)", status=2)
    expect_failure("check, far away", run("check", "far.toml"), "4e-10 m a step", status=2)
    write("far.toml", replaced(far, ("[4e-6", "[4e-3")))
    done = run("check", "far.toml")
    expect(done.returncode == 0 and "fewer than three digits" in done.stdout, f"check with few digits: {done.stdout}")
    fresh("far.out")
    done = run("run", "far.toml", "--quiet")
    expect(done.returncode == 0 and any("fewer than three digits" in line for line in messages(done)),
           f"run with few digits: {done.stderr}")


def check_overflow():
    heavy = replaced(SHOT, ("density = 1000.0", "density = 1e307"), ("normal_stiffness = 1e3", "normal_stiffness = 1e300"),
                    ("radius = 0.2 }", "radius = 0.2, velocity = [60.0, 0.0] }"))
    high = replaced(heavy, ("dimension = 2", "dimension = 2\ngravity = [0.0, -981.0]"), *[("[60.0, 0.0]", "[0.0, 0.0]")] * 2)
    for deck, what in ((heavy, "kinetic"), (high, "gravitational")):
        write("heavy.toml", deck)
        for ranks in (1, 2):
            fresh("heavy.out")
            expect_failure("overflow", run("run", "heavy.toml", "--quiet", ranks=ranks), f"at step 0 the {what} energy")


check_shots()
check_warnings()
check_fall()
check_too_fast()
check_far_away()
check_overflow()
finish()
