#!/usr/bin/env python3
"""The package barchan: the same bits as the command on any ranks, views that never dangle, errors in words.

First argument: the command. The package is that of the build folder; skipped (77) where it was not built.
"""
import os
import pathlib
import re
import subprocess
import sys

TREE = pathlib.Path(os.environ["BARCHAN_SOURCE"])
PACKAGES = pathlib.Path(os.environ["BARCHAN_BUILD"]) / "python"
DECK = str(TREE / "tests/install/abi.toml")
sys.path.insert(0, str(PACKAGES))
sys.path.insert(1, str(TREE / "examples/python"))


def raises(kind, words, call):
    try:
        call()
    except kind as error:
        assert words in str(error), f"{words!r} in {str(error)!r}"
        return
    raise AssertionError(f"no {kind.__name__} about {words!r}")


def drag(sim):
    for brick in sim.owned():
        brick.forces[:] = -2.0 * brick.velocities
        brick.torques_by_radius[:] = -0.1 * brick.surface_speeds


def course(barchan, comm, excursions, by_id=False):
    """A digest, with excursions that are taken back, particles that go and come, walls and gravity that change."""
    import numpy as np
    with barchan.Simulation(DECK, comm, set={"particles.1.seed": 5}, threads=2) as sim:
        state = None
        for k in range(6):
            if excursions:
                state = sim.save(state)
                sim.run(3 * k + 1)
                drag(sim)
                sim.set_gravity([0, 5])
                sim.load(state)
            if by_id:
                for brick in sim.owned():
                    order = np.argsort(brick.ids)[::-1]
                    radii = brick.radii[order]
                    sim.set_loads(brick.ids[order], -2.0 * brick.velocities[order],
                                  -0.1 * brick.surface_speeds[order] * radii)
            else:
                drag(sim)
            sim.run(10)
        sim.remove(range(1, 40, 3))
        ids = sim.add([[0.5, 0.8], [2.5, 0.85]], 0.025, velocity=[1.0, 0.0], material="sand")
        assert ids.tolist() == [sim.info["num_particles"] + 13 - 1, sim.info["num_particles"] + 13], ids
        sim.walls["ceiling"].set_velocity([0.0, -0.5])
        sim.set_gravity([0.0, -4.0])
        sim.scatter("velocity", ids, [[0.0, -1.0], [0.0, 1.0]])
        sim.walls["ceiling"].set_pose([0.0, 1.05], [0.0, -2.0])
        sim.set_contact("sand", "sand", friction=0.1, restitution=0.9)
        sim.set_time_step(1.3e-4)
        sim.advance_to(sim.time + 0.00777)
        return sim.digest()


def views(barchan):
    import numpy as np
    sim = barchan.Simulation(DECK, threads=1)
    sim.run(5)
    brick = sim.owned()[0]
    x, f = brick.positions, brick.forces
    assert x.shape == (len(brick), 2) and not x.flags.writeable and not x.flags.owndata
    raises(ValueError, "read-only", lambda: x.__setitem__((0, 0), 1.0))
    before, part = x.copy(), x[3:7, 0]
    f[:] = [0.5, 0.25]
    ids, forces = sim.gather("force")
    sim.set_loads(brick.ids, np.tile([0.5, 0.25], (len(brick), 1)))
    assert not sim.gather("torque")[1].any()
    assert np.array_equal(forces, np.tile([0.5, 0.25, 0.0], (len(ids), 1)))
    for n in (2, 3, 4):  # numbers about z, not a vector for all, for as many particles as a vector has components, too
        about_z = 1e-3 * np.arange(1.0, n + 1)
        sim.set_loads(ids[:n], np.zeros((n, 2)), about_z)
        torques = sim.gather("torque")[1][:n]
        assert np.allclose(torques[:, 2], about_z, rtol=1e-12) and not torques[:, :2].any(), torques
    sim.run(300)
    raises(barchan.StaleView, "owned()", lambda: brick.positions)
    raises(barchan.StaleView, "over", lambda: len(brick))
    raises(ValueError, "read-only", lambda: f.__setitem__(0, 0.0))
    assert np.array_equal(x, before) and np.array_equal(part, before[3:7, 0])
    now = sim.owned()[0].velocities
    kept = now.copy()
    del sim  # arrays outlive their simulation
    assert np.array_equal(now, kept)


def links(barchan):
    """What lies on the floor presses it with the weight of all once it rests."""
    import numpy as np
    with barchan.Simulation(DECK, set={"gravity": [0, -9.81], "particles.1.region.hi": [4, 0.15]}) as sim:
        assert len(sim.bonds()) == 0
        sim.advance_to(0.80003)
        assert sim.time == 0.80003
        floor, pairs = sim.wall_contacts(), sim.contacts()
        assert len(pairs) > 0 and pairs.normals.shape == (len(pairs), 3) and (pairs.first < pairs.second).all()
        assert np.allclose(np.linalg.norm(pairs.normals, axis=1), 1.0)
        weight = 9.81 * sim.gather("mass")[1].sum()
        pressed = floor.normal_forces[floor.second == 0].sum()
        assert abs(pressed - weight) < 0.02 * weight, (pressed, weight)
        assert np.allclose(floor.normals[:, 1], -1.0) and np.array_equal(sim.walls["floor"].normal, [0, 1, 0])


def own_fields(barchan):
    """They stay with their particles while rows move, and through states and checkpoints."""
    import numpy as np
    with barchan.Simulation(DECK, threads=2) as sim:
        assert sim.fields == {} and sim.add_field("dose") and not sim.add_field("dose") and sim.add_field("path", 3)
        for brick in sim.owned():
            brick.field("dose")[:] = 2.0 * brick.ids
            kept = brick.field("path")
            kept[:, 1] = brick.ids
        sim.run(300)
        raises(ValueError, "read-only", lambda: kept.__setitem__((0, 0), 1.0))
        state = sim.save()
        sim.scatter("path", [4, 2], np.ones((2, 3)))
        ids, doses = sim.gather("dose")
        paths = sim.gather("path")[1]
        assert np.array_equal(doses, 2.0 * ids) and paths.shape == (len(ids), 3) and sim.fields == {"dose": 1, "path": 3}
        assert np.array_equal(paths[[1, 3]], np.ones((2, 3))) and np.array_equal(paths[4:, 1], ids[4:])
        sim.load(state)
        assert sim.gather("path")[1][1, 1] == 2.0
        sim.write_checkpoint("fields")
        raises(barchan.InputError, "of 1 components, not 2", lambda: sim.add_field("dose", 2))
        raises(ValueError, "no field is called 'dosis'", lambda: sim.owned()[0].field("dosis"))
        raises(barchan.InputError, "1 numbers for 2 particles", lambda: sim.scatter("dose", [1, 2], [1.0]))
    with barchan.Simulation(DECK, checkpoint="fields") as sim:
        assert not sim.add_field("dose") and np.array_equal(sim.gather("dose")[1], 2.0 * ids)


def callbacks(barchan):
    """on_step gives the bits of loads between runs; what a callback raises ends the run, and nothing else is lost."""
    with barchan.Simulation(DECK) as sim:
        for _ in range(10):
            drag(sim)
            sim.run(10)
        expected = sim.digest()
    with barchan.Simulation(DECK, threads=2) as sim:
        steps, bricks_kept, checkpoints = [], [], []

        def load(bricks):
            for brick in bricks:
                brick.forces[:] = -2.0 * brick.velocities
                brick.torques_by_radius[:] = -0.1 * brick.surface_speeds
            bricks_kept[:] = bricks

        def progress(step, time):
            assert time == sim.time and step == sim.info["step"]
            raises(RuntimeError, "from within run()", sim.measure)
            raises(RuntimeError, "may not close", sim.close)
            steps.append(step)

        sim.on_step(10, load)
        sim.on_progress(25, progress)
        sim.on_checkpoint(lambda step, folder, error: checkpoints.append((step, folder, error)))
        sim.keep_checkpoints("kept", every_steps=30)
        sim.run(100)
        assert sim.digest() == expected and steps == [25, 50, 75, 100]
        assert [c[0] for c in checkpoints][:2] == [30, 60] and all(c[2] == "" and "kept" in c[1] for c in checkpoints), checkpoints
        raises(barchan.StaleView, "over", lambda: bricks_kept[0].positions)
        state = sim.save()

        def fail(bricks):
            raise KeyError("no such thing")

        sim.on_step(7, fail)
        raises(barchan.RunEnded, "step 105: on_step_together, rank 0: KeyError: 'no such thing' at ", lambda: sim.run(50))
        raises(barchan.RunEnded, "no such thing", lambda: sim.run(1))
        raises(barchan.InputError, "every 0 steps", lambda: sim.on_step(0, fail))
        sim.on_step(1, None)
        sim.load(state)
        assert sim.run(5) == 5


def stubs(barchan):
    """The stubs name all that the compiled part has, and nothing else."""
    import ast
    from barchan import _barchan

    def public(names):
        return {n for n in names if not n.startswith("_")} - {"name", "value"}  # of enums

    tree = ast.parse((TREE / "bindings/python/barchan/_barchan.pyi").read_text())

    def declared(body):
        names = {n.name for n in body if isinstance(n, (ast.ClassDef, ast.FunctionDef))}
        names |= {n.target.id for n in body if isinstance(n, ast.AnnAssign)}
        return names | {t.id for n in body if isinstance(n, ast.Assign) for t in n.targets}

    assert public(vars(_barchan)) == public(declared(tree.body)), public(vars(_barchan)) ^ public(declared(tree.body))
    for node in tree.body:
        if isinstance(node, ast.ClassDef) and not node.name.endswith(("Error", "Ended", "View")):
            of_class = public(vars(getattr(_barchan, node.name)))
            assert of_class == public(declared(node.body)), (node.name, of_class ^ public(declared(node.body)))
    for name in ("Simulation", "Wall", "Links", "Measures", "Run"):
        for key, value in vars(getattr(barchan, name)).items():
            assert key.startswith("_") or not callable(value) or value.__doc__, f"{name}.{key} has no docstring"


def wrong_calls(barchan):
    import numpy as np
    raises(barchan.InputError, "no.toml", lambda: barchan.Simulation("no.toml"))
    raises(barchan.InputError, "stepp", lambda: barchan.Simulation(DECK, set={"time.stepp": 1}))
    raises(ValueError, "schedule", lambda: barchan.Simulation(DECK, schedule="late"))
    raises(barchan.InputError, "100000 threads a rank (at most 1024)", lambda: barchan.Simulation(DECK, threads=100000))
    raises(TypeError, "communicator", lambda: barchan.Simulation(DECK, comm="world"))
    raises(TypeError, "cannot hold", lambda: barchan.Simulation({"title": None}))
    with barchan.Simulation(DECK) as sim:
        raises(ValueError, "is not on rank 0", lambda: sim.set_loads([10**6], [[0, 0]]))
        raises(ValueError, "shape", lambda: sim.set_loads([1, 2, 4], [[0, 0]]))
        raises(barchan.InputError, "no particle", lambda: sim.remove([10**6]))
        raises(ValueError, "ids are whole numbers, not 1.5", lambda: sim.set_loads([1.0, 1.5], [[0, 0], [0, 0]]))
        raises(ValueError, "types are whole numbers", lambda: sim.add([1.0, 0.8], 0.02, material=0.5))
        raises(barchan.InputError, "particle 4 is named twice", lambda: sim.scatter("velocity", [4, 2, 4], np.zeros((3, 2))))
        raises(ValueError, "of barchan's own", lambda: sim.add_field("position"))
        raises(barchan.InputError, "is no name", lambda: sim.add_field("größe"))
        raises(barchan.InputError, "is unstable", lambda: sim.add([1.0, 0.8], 1e-4))
        raises(TypeError, "not an instance of 'function'", lambda: sim.on_progress(1, 5))
        raises(barchan.InputError, "keep 1 to 1000", lambda: sim.keep_checkpoints("kept", keep=0))
        raises(ValueError, "no field 'mas'", lambda: sim.gather("mas"))
        raises(ValueError, "no material", lambda: sim.add([0, 0], 0.1, material="gold"))
        raises(ValueError, "types of materials", lambda: sim.add([0, 0], 0.1, material=7))
        raises(barchan.InputError, "into wall 'floor'", lambda: sim.add([1.0, 0.001], 0.02))
        raises(barchan.InputError, "unstable", lambda: sim.set_time_step(1.0))
        raises(barchan.InputError, "wall 'floor'", lambda: sim.walls["floor"].set_pose([0, 0.3]))
        raises(barchan.InputError, "there are friction", lambda: sim.set_contact("sand", "sand", stiff=1.0))
        raises(ValueError, "no material is called 'gold'", lambda: sim.set_contact("sand", "gold", friction=1))
        raises(KeyError, "lid", lambda: sim.walls["lid"])
        raises(barchan.InputError, "not loaded", lambda: sim.walls["floor"].set_load(1.0))
        raises(RuntimeError, "empty", lambda: sim.load(barchan.State()))
        raises(ValueError, "-1 steps", lambda: sim.run(-1))
        assert sim.measure().kinetic == 0.0
        assert "disks in a box" in repr(sim) and "floor" in repr(sim.walls["floor"])
    raises(RuntimeError, "closed", lambda: sim.run(1))


def from_dicts_and_files(barchan, command):
    """A deck as a dict gives the bits of the command; its folder can be read; a checkpoint continues."""
    import tomllib
    import numpy as np
    with open(DECK, "rb") as file:
        deck = tomllib.load(file)
    with barchan.Simulation(deck, set={"time.end": 0.04}) as sim:
        sim.run(100)
        sim.write_checkpoint("checkpoints")
        sim.run(100)
        digest, end = sim.digest(), sim.gather("position")
    subprocess.run([command, "run", DECK, "--quiet", "--out", "run.out", "--force", "--set", "time.end=0.04"], check=True)
    run = barchan.read("run.out")
    assert run.figures["state_digest"] == digest
    assert run.series["step"].dtype == np.int64 and run.series["step"][-1] == 200
    last = run.snapshot()
    assert np.array_equal(last["id"], end[0]) and np.array_equal(last["position"], end[1])
    raises(LookupError, "no snapshot of step 7", lambda: run.snapshot(7))
    raises(FileNotFoundError, "no folder", lambda: barchan.read("none.out"))
    with barchan.Simulation(deck, set={"time.end": 0.04}, checkpoint="checkpoints") as sim:
        assert sim.step == 100
        sim.advance_to(0.04)
        assert sim.digest() == digest


def say(digest):
    """One write a rank: what several ranks print in pieces comes out mixed."""
    os.write(1, f"[{digest}]\n".encode())


def example(name, *arguments, ranks=1):
    """What it prints; that it ends well."""
    environment = {**os.environ, "PYTHONPATH": str(PACKAGES)}
    command = [sys.executable, str(TREE / "examples/python" / name), *arguments]
    return subprocess.run(["mpirun", "-n", str(ranks), *command] if ranks > 1 else command, check=True, env=environment,
                          stdout=subprocess.PIPE, text=True).stdout


def examples_under_mpi():
    assert "theory says" in example("custom_drag.py", ranks=2)
    try:
        import mpi4py  # noqa: F401
    except ImportError:
        return
    assert example("sub_communicator.py", ranks=3).count("mean height") == 5


def plot_of_a_run():
    try:
        import matplotlib  # noqa: F401
    except ImportError:
        return
    example("plot_run.py", "run.out")
    assert pathlib.Path("run.png").stat().st_size > 10000


def inner(kind):
    import barchan
    if kind == "world":
        return say(course(barchan, None, excursions=True))
    try:
        from mpi4py import MPI
    except ImportError:
        return say("none")
    half = MPI.COMM_WORLD.Split(MPI.COMM_WORLD.rank // 2, MPI.COMM_WORLD.rank)  # two simulations side by side
    return say(course(barchan, half, excursions=True, by_id=True))


def main():
    if len(sys.argv) > 2:
        return inner(sys.argv[2])
    if not list((PACKAGES / "barchan").glob("_barchan*.so")):
        print("the package was not built (Debian: pybind11-dev, python3-dev)")
        return 77
    try:
        import numpy  # noqa: F401
    except ImportError:
        print("no NumPy (Debian: python3-numpy)")
        return 77
    found = {}
    for ranks, kind in ((2, "world"), (3, "mpi4py")):  # before this process starts MPI, which children would inherit
        out = subprocess.run(["mpirun", "-n", str(ranks), sys.executable, __file__, sys.argv[1], kind],
                             check=True, stdout=subprocess.PIPE, text=True).stdout
        found[kind] = set(re.findall(r"\[(\w+)\]", out)) - {"none"}
    examples_under_mpi()
    import barchan
    expected = course(barchan, None, excursions=False)
    assert found["world"] == {expected} and found["mpi4py"] <= {expected}, f"{found}, and {expected} on one rank"
    views(barchan)
    links(barchan)
    own_fields(barchan)
    callbacks(barchan)
    stubs(barchan)
    wrong_calls(barchan)
    from_dicts_and_files(barchan, sys.argv[1])
    plot_of_a_run()
    help_text = barchan.Simulation.__doc__ + barchan.Simulation.run.__doc__
    assert "RunEnded" in help_text and "InputError" in help_text
    return 0


if __name__ == "__main__":
    sys.exit(main())
