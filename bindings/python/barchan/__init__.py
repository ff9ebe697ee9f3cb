"""barchan: discrete elements, disks and spheres, with the same bits on any number of ranks and threads.

    import barchan

    with barchan.Simulation("bed.toml", set={"time.step": 1e-5}) as sim:
        while sim.time < 0.1:
            for brick in sim.owned():                       # arrays of this rank, without a copy
                brick.forces[:] = -0.1 * brick.velocities   # written in place
            sim.run(10)
        print(sim.measure().kinetic, sim.digest())

    run = barchan.read("bed.out")                           # what `barchan run` wrote
    print(run.figures["state_digest"], run.series["kinetic_energy"].max())

Under MPI pass `comm=MPI.COMM_WORLD` of mpi4py, or any communicator of some ranks; without, a run is one of
MPI_COMM_WORLD. All quantities are in SI units.
"""
from ._barchan import InputError, RunEnded, RunError, StaleView, State, version as __version__
from .parts import Links, Measures, Wall
from .results import Run, read
from .simulation import Simulation

__all__ = ["InputError", "Links", "Measures", "Run", "RunEnded", "RunError", "Simulation", "StaleView", "State", "Wall",
           "read", "__version__"]
