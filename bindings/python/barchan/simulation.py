"""Simulations, from decks, under MPI."""
from __future__ import annotations

import os
from typing import Any, Dict, List, Mapping, Optional, Tuple, Union

import numpy as np

from . import _barchan
from ._events import Events
from ._toml import deck_text, value_text
from ._values import Vector, field as field_of, handle_of, three, turns, vectors, whole
from .parts import Links, Measures, Wall

__all__ = ["Simulation"]


class Simulation(Events):
    """A simulation on all ranks of a communicator.

    Construction, run, advance_to, set_time_step, measure, digest, gather, scatter, contacts, wall_contacts, bonds, add,
    remove, add_field, set_gravity, set_contact, walls' set_..., save, load, write_checkpoint, keep_checkpoints, on_...
    but on_departure, and close are collective: all ranks call them in the same order. The rest is local. One thread at a
    time: a second one meets RuntimeError, as does a call after close().

    Views are of a moment: run(), load(), add(), remove(), add_field(), scatter(), set_gravity(), set_time_step(),
    set_pose() and clear_loads() end it. A view then raises StaleView. An array that came from it stays safe: it keeps the values of its moment, and cannot be written.

    Args:
        deck: path of a deck, or a dict with the same tables and keys (docs/deck.md).
        comm: a communicator of mpi4py, or its Fortran handle; None: all ranks.
        set: keys of the deck with other values, as `--set`: {"time.step": 1e-5, "wall.lid.load": 500}.
        threads: of this rank; 0: cores of the node over ranks on it.
        exchange, vector, schedule: as the options of `barchan run`.
        checkpoint: a folder to continue from; None: from the start.

    Raises:
        InputError: the same on every rank, for a deck that cannot run; with file, line and remedy.
    """

    def __init__(self, deck: Union[str, os.PathLike, Mapping[str, Any]], comm: Any = None, *,
                 set: Optional[Mapping[str, Any]] = None, threads: int = 1, exchange: str = "auto",
                 vector: str = "auto", schedule: str = "overlap",
                 checkpoint: Union[str, os.PathLike, None] = None):
        opening = _barchan.Opening()
        if isinstance(deck, Mapping):
            opening.text = deck_text(dict(deck)) or "\n"
        else:
            opening.path = os.fspath(deck)
        if schedule not in ("overlap", "sequential"):
            raise ValueError(f"schedule is 'overlap' or 'sequential', not {schedule!r}")
        if threads < 0:
            raise ValueError(f"{threads} threads: 1 or more, or 0 for the cores of the node over its ranks")
        opening.overrides = [(key, value_text(value)) for key, value in (set or {}).items()]
        opening.threads, opening.exchange, opening.vector, opening.schedule = threads, exchange, vector, schedule
        opening.checkpoint = "" if checkpoint is None else os.fspath(checkpoint)
        opening.comm = handle_of(comm)
        self._inside = _barchan.open(opening)

    def __enter__(self) -> "Simulation":
        return self

    def __exit__(self, *_: Any) -> None:
        self.close()

    def close(self) -> None:
        """Ends the simulation; arrays of it keep their values. Collective."""
        self._inside.close()

    # ---- what it is, and when
    @property
    def time(self) -> float:
        """[s]; positions are of this time, velocities half a step behind."""
        return self._inside.info()["time"]

    @property
    def step(self) -> int:
        return self._inside.info()["step"]

    @property
    def info(self) -> Dict[str, Any]:
        """time, step, dt, stage, dimension, num_particles, num_owned, threads, exchange, walls, materials and so on."""
        return self._inside.info()

    @property
    def num_particles(self) -> int:
        """On all ranks, now."""
        return self._inside.info()["num_particles"]

    @property
    def walls(self) -> Dict[str, Wall]:
        """By name: `sim.walls["lid"].set_velocity([0, 0, -0.1])`."""
        return {name: Wall(self, name) for name in self._inside.info()["walls"]}

    def notes(self) -> List[str]:
        """Events on this rank since the last call; rank 0 has those that all ranks know."""
        return self._inside.take_notes()

    # ---- time
    def run(self, steps: int) -> int:
        """Advances by so many steps; fewer when the last stage ends. Returns steps done.

        Raises:
            RunEnded: on every rank, between two steps: the state can be read, saved, or replaced by load().
            RunError: perhaps on this rank only, while others wait: end all ranks.
        """
        return self._inside.run(steps)

    def advance_to(self, time: float) -> int:
        """Runs until it is `time` [s]: whole steps, and a shorter last one where one is needed. Returns steps done.

        Raises:
            ValueError: a time that has passed.
            InputError: not finite, or not the same on every rank.
            RunEnded, RunError: as run().
        """
        return self._inside.advance_to(time)

    def set_time_step(self, dt: float) -> None:
        """The length of steps from now on [s]. Collective; the same on every rank.

        Raises:
            InputError: not above zero, or unstable; nothing has changed.
        """
        self._inside.set_time_step(float(dt))

    def measure(self) -> Measures:
        """Energies, contacts, overlap, momentum of all ranks; afterwards walls know their forces."""
        return Measures(**{k: tuple(v) if isinstance(v, list) else v for k, v in self._inside.measure().items()})

    def digest(self) -> str:
        """Of the state of all ranks: sixteen digits, equal for equal states (docs/determinism.md)."""
        return f"{self._inside.digest():016x}"

    # ---- arrays
    def owned(self) -> List[_barchan.Brick]:
        """The particles of this rank, a view for each brick: ids, positions, velocities, surface_speeds, radii,
        inverse_masses, densities, types to read, without a copy; forces, torques_by_radius and field(name) to write in
        place."""
        return self._inside.owned()

    def set_loads(self, ids: Any, forces: Any, torques: Any = None) -> None:
        """Sets loads on these particles of this rank; others keep theirs. They act in every step until they are
        set again or cleared.

        Args:
            ids: (n); in the order of owned() it is fastest.
            forces: (n, 3), in 2D also (n, 2) [N].
            torques: (n, 3), in 2D also (n) about z [N·m]; None: zeros.

        Raises:
            ValueError: an id of another rank, other shapes, a number that is not finite; nothing is set.
        """
        ids = whole(ids, "ids")
        rows = vectors(forces, len(ids), "forces")
        about = np.empty(0) if torques is None else turns(torques, len(ids), "torques")
        self._inside.set_loads(ids, rows, about)

    def clear_loads(self) -> None:
        """No loads any more, on this rank."""
        self._inside.clear_loads()

    def gather(self, field: str) -> Optional[Tuple[np.ndarray, np.ndarray]]:
        """A field of all particles: (ids, values) in order of ids on rank 0, None elsewhere. Collective.

        Args:
            field: position, velocity, angular_velocity, force, torque (n, 3); radius, mass, type, temperature (n); or one
                of your own (n, components).

        Raises:
            ValueError: there is no such field.
        """
        if field in (own := self.fields):
            return self._inside.gather_field(field, own[field])
        return self._inside.gather(field_of(field))

    def scatter(self, field: str, ids: Any, values: Any) -> None:
        """Sets velocity, angular_velocity, force, torque, temperature or a field of your own of any particles.
        Collective; the same lists on every rank.

        Args:
            values: (n, 3), in 2D also (n, 2) [m/s, N]; angular_velocity and torque in 2D also (n) about z [rad/s, N·m];
                temperature (n) [K]; of your own (n, components).

        Raises:
            InputError: an id that there is not, other shapes, a number that is not finite; nothing has changed.
        """
        ids = whole(ids, "ids")
        if field in self.fields:
            return self._inside.scatter_field(field, ids, np.asarray(values, dtype=float))
        what = field_of(field)
        if field == "temperature":
            return self._inside.scatter(what, ids, np.ascontiguousarray(values, dtype=float).ravel())
        rows = turns if field in ("angular_velocity", "torque") else vectors
        self._inside.scatter(what, ids, rows(values, len(ids), "values"))

    @property
    def fields(self) -> Dict[str, int]:
        """Your own fields: name to components."""
        return self._inside.fields()

    def add_field(self, name: str, components: int = 1) -> bool:
        """A field of your own: numbers of every particle that travel with it, through states and checkpoints, and that
        barchan never reads. `brick.field(name)` is an array to read and write in place. Collective; the same on every rank.

        The numbers are 0 at first, and of newcomers. Returns False where there is such a field, as after a restart: it
        keeps its values.

        Raises:
            ValueError: a name that gather() has for a field of barchan's.
            InputError: no name (letters, digits and _), other components than the field has, more than 256 numbers.
        """
        if name in _barchan.Field.__members__:
            raise ValueError(f"{name!r} is a field of barchan's own: give yours another name")
        return self._inside.add_field(name, components)

    def contacts(self) -> Links:
        """Pairs of particles that touch, or hold each other from afar. A copy. Collective."""
        return self._links("contacts")

    def wall_contacts(self) -> Links:
        """Particles that walls push or hold. A copy. Collective."""
        return self._links("wall_contacts")

    def bonds(self) -> Links:
        """Whole bonds. A copy. Collective."""
        return self._links("bonds")

    def _links(self, kind: str) -> Links:
        return Links(**self._inside.links(_barchan.LinkKind.__members__[kind]))

    # ---- changes in the course
    def add(self, position: Any, radius: Any, *, velocity: Any = 0.0, omega: Any = 0.0,
            material: Union[str, Any] = 0, density: Any = None, ids: Any = None) -> np.ndarray:
        """Particles that come now. Collective; the same on every rank. Returns their ids.

        Args:
            position: (n, 3), in 2D also (n, 2) [m].
            radius: one, or (n) [m]; no larger than the largest at the start.
            velocity, omega: vectors [m/s, rad/s], half a step behind the position.
            material: its name, or types from 0.
            density: None: that of the material.
            ids: None: the next ones that are free.

        Raises:
            ValueError: other shapes, no such material.
            InputError: an id that is taken, no room there, larger than cells allow, a step that would be too long; nothing
                is added.
        """
        position = np.atleast_2d(np.asarray(position, dtype=float))
        n = len(position)
        if isinstance(material, str):
            materials = self._inside.info()["materials"]
            if material not in materials:
                raise ValueError(f"no material is called {material!r}: there are {', '.join(materials)}")
            material = materials.index(material)
        types = np.broadcast_to(whole(material, "types"), n)
        if density is None:
            known = len(self._inside.info()["materials"])
            if n and not 0 <= types.min() <= types.max() < known:
                raise ValueError(f"types of materials are from 0 to {known - 1}")
            density = np.array([self._inside.material_density(int(t)) for t in types])
        if ids is None:
            ids = self._inside.highest_id() + 1 + np.arange(n)
        ids = whole(ids, "ids")
        if len(ids) != n:
            raise ValueError(f"{len(ids)} ids for {n} particles")
        if np.shape(omega) == (3,):  # one vector for all, of three particles, too
            omega = np.broadcast_to(omega, (n, 3))
        motion = np.hstack([vectors(position, n, "position"), vectors(velocity, n, "velocity"),
                            turns(omega, n, "omega")])
        self._inside.add(ids, types, np.broadcast_to(np.asarray(radius, dtype=float), n),
                         np.broadcast_to(np.asarray(density, dtype=float), n), motion)
        return ids

    def remove(self, ids: Any) -> None:
        """Particles that go now, with contacts and bonds. Collective; the same on every rank.

        Raises:
            InputError: an id that there is not, or that is named twice; nothing is removed.
        """
        self._inside.remove(whole(ids, "ids"))

    def set_gravity(self, gravity: Vector) -> None:
        """From the next step on [m/s²]. Collective; the same on every rank.

        Raises:
            InputError: not finite, not the same on every rank, or along z in 2D.
        """
        self._inside.set_gravity(three(gravity))

    def set_contact(self, a: str, b: str, **numbers: float) -> None:
        """What two materials have together from the next step on: `sim.set_contact("sand", "steel", friction=0.3)`.

        Collective; the same on every rank.

        Args:
            numbers: under the keys of a deck: friction, restitution, normal_stiffness and so on; others stay.

        Raises:
            ValueError: there is no such material.
            InputError: no such key, a value without a meaning, a step that would be too long; nothing has changed.
        """
        self._inside.set_contact(a, b, {key: float(value) for key, value in numbers.items()})

    # ---- back and again
    def save(self, state: Optional[_barchan.State] = None) -> _barchan.State:
        """The present state, in memory; `state`: a former one whose memory is used again. Collective."""
        state = _barchan.State() if state is None else state
        self._inside.save(state)
        return state

    def load(self, state: _barchan.State) -> None:
        """All is as it was when `state` was saved, to the bit. After RunEnded, too. Collective.

        Raises:
            RuntimeError: the state is empty, or of another simulation.
        """
        self._inside.load(state)

    def write_checkpoint(self, folder: Union[str, os.PathLike]) -> None:
        """Writes the present state to a folder; Simulation(deck, checkpoint=folder) continues. Collective.

        Raises:
            OSError: it is not on the disk, on every rank.
        """
        if not self._inside.write_checkpoint(os.fspath(folder)):
            raise OSError(f"the checkpoint could not be written to {os.fspath(folder)}")

    def __repr__(self) -> str:
        what = self._inside.info()
        return f"<barchan simulation {what['title']!r}: {what['num_particles']} particles, step {what['step']}>"
