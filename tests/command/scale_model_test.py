"""The model of many ranks: closed forms where there are any, and the committed sweep over delays within a few percent."""
import json
import os
import subprocess
import sys

from _helper import expect, finish, fresh, write

TREE = os.environ["BARCHAN_SOURCE"]
HOME = os.path.join(TREE, "bench", "scale_model")
sys.path.insert(0, HOME)
sys.dont_write_bytecode = True

import model  # noqa: E402

PACK = model.Problem("spheres", 3, 0.016, 0.15, 50, 0.8, 1.3, 72.0)
QUIET = model.Spread(0.0, 0.0)
FAST = model.Network("fast", 1.0, 1e6, 0.5, 0.0)


def check_geometry():
    cube = model.brick(PACK, 1e5, 1000, "bricks")
    edge = (1e5 / 1.3) ** (1 / 3)
    expect(cube.links == 26 and cube.sides == (2, 2, 2), f"a brick inside: {cube}")
    expect(abs(cube.surplus - 9 / 8 / edge) < 1e-12, f"pairs computed twice: {cube.surplus}")
    expect(abs(cube.ghosts / 1e5 - ((1 + 2 / edge) ** 3 - 1)) < 1e-12, f"ghosts: {cube.ghosts}")
    expect(model.brick(PACK, 1e5, 1000, "strips") is None, "a thousand strips of 1e8 spheres are thinner than two cells")
    expect(model.brick(PACK, 1e5, 2, "strips").links == 1, "two strips have one link each")
    expect(model.factors(100000, 3) in ((50, 50, 40), (40, 50, 50), (50, 40, 50)), f"100,000 as {model.factors(100000, 3)}")


def step_of(network, particles=1e4):
    share = model.Brick(particles, (particles / 400, 20, 20), (1, 0, 0), 1)
    problem = model.Problem("no rebuilds", 3, 0.016, 0.0, 100, 0.0, 1.0, 72.0)
    return problem, share, model.simulate(problem, network, QUIET, share, (2, 1, 1))


def check_two_ranks():
    problem, share, step = step_of(FAST)
    work = 0.016 * 1e4 * (1 + share.surplus)
    expect(abs(step - work - 0.5) < 0.01 * work, f"a short message is hidden: {step} for {work} of work")
    _, _, step = step_of(model.Network("slow", 1000.0, 1e6, 0.5, 0.0))
    least = 1000.0 + work * share.rim + 0.5
    expect(abs(step - least) < 0.03 * least, f"a long message is the step: {step} for {least}")
    alone = model.simulate(problem, FAST, QUIET, model.Brick(1e4, (25, 20, 20), (0, 0, 0), 0), (1, 1, 1))
    expect(abs(alone - 160) < 1e-6, f"one rank: {alone}")


def check_committed_sweep():
    fresh("work")
    write("inputs.json", json.dumps({"problems": {"pack3d": PACK.__dict__ | {"spread_of_speed": 0.0}}}))
    done = subprocess.run(["/usr/bin/python3", os.path.join(HOME, "scale_model"), "--quick", "--parts", "validate,weak",
                           "--inputs", "inputs.json", "--out", "work"], capture_output=True, text=True, timeout=120)
    expect(done.returncode == 0 and "modelled" in done.stdout, f"scale_model: {done}")
    with open("work/scale_model.json") as file:
        made = json.load(file)
    rows = [row for row in made["validation"]["rows"] if not row["is_given"]]
    worst = max(abs(row["predicted"] / row["measured"] - 1) for row in rows)
    expect(len(rows) >= 15 and worst < 0.07, f"{len(rows)} predictions, the worst {worst:.3f} off")
    bricks = [row["efficiency"] for row in made["weak"] if (row["network"], row["shape"]) == ("cluster", "bricks")]
    strips = [row for row in made["weak"] if (row["network"], row["shape"], row["ranks"]) == ("cluster", "strips", 1000)]
    expect(0.85 < min(bricks) <= max(bricks) <= 1.0001 and not strips, f"weak: {bricks}, {strips}")


check_geometry()
check_two_ranks()
check_committed_sweep()
finish()
