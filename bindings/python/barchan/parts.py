"""What a simulation gives: measures, links, walls."""
from __future__ import annotations

import dataclasses
from typing import TYPE_CHECKING, Optional, Tuple

import numpy as np

from ._values import Vector, three

if TYPE_CHECKING:
    from .simulation import Simulation

__all__ = ["Links", "Measures", "Wall"]


@dataclasses.dataclass(frozen=True)
class Measures:
    """Sums over all ranks, exact whatever their order."""
    kinetic: float  #: energy [J]
    elastic: float  #: of contacts and bonds [J]
    gravitational: float  #: [J]
    momentum: Tuple[float, float, float]  #: [N·s]
    contacts: int  #: touching pairs without a bond
    bonds: int  #: whole ones
    broken_bonds: int  #: since the start
    max_overlap: float  #: [m]
    max_overlap_share: float  #: of the smaller radius
    max_speed: float  #: [m/s]


@dataclasses.dataclass(frozen=True)
class Links:
    """Contacts or bonds that count on this rank, in any order, with the forces that the next step finds in them."""
    first: np.ndarray  #: (n) ids; of two particles the lower one
    second: np.ndarray  #: (n) ids; of contacts with walls the wall's place in `sim.walls`, from 0
    normals: np.ndarray  #: (n, 3) from the first to the second, of length 1
    overlaps: np.ndarray  #: (n) [m]; of a bond by how much it is shorter than unstressed
    normal_forces: np.ndarray  #: (n) above zero they push the two apart [N]
    tangential_forces: np.ndarray  #: (n, 3) on the first; the second feels the opposite [N]

    def __len__(self) -> int:
        return len(self.first)


class Wall:
    """A wall of a simulation: where it is, what acts on it, and how it moves.

    `point` [m], `normal`, `velocity` [m/s]; `force` [N], `torque` about the point [N·m] and `work` [J] are those of the last
    measure().
    """

    def __init__(self, simulation: "Simulation", name: str):
        self._simulation, self.name = simulation, name

    def __getattr__(self, name: str):
        if name not in ("point", "normal", "velocity", "force", "torque", "work", "is_active"):
            raise AttributeError(f"a wall has no {name!r}: point, normal, velocity, force, torque, work, is_active")
        value = self._simulation._inside.wall(self.name)[name]
        return np.array(value) if isinstance(value, list) else value

    def set_velocity(self, velocity: Vector) -> None:
        """From the next step on [m/s]. Collective; the same on every rank.

        Raises:
            InputError: the wall is moved by its load, or ranks give different values.
        """
        self._simulation._inside.set_wall_velocity(self.name, three(velocity))

    def set_load(self, load: float) -> None:
        """Of a loaded plate, along its normal [N/m²]. Collective; the same on every rank.

        Raises:
            InputError: the wall is not loaded.
        """
        self._simulation._inside.set_wall_load(self.name, float(load))

    def set_pose(self, point: Vector, normal: Optional[Vector] = None) -> None:
        """Puts it elsewhere at once [m]; normal: of any length, None: as it is. Collective; the same on every rank.

        Raises:
            InputError: a particle would reach into the wall by more than half of its radius; nothing has changed.
        """
        self._simulation._inside.set_wall_pose(self.name, three(point), three(self.normal if normal is None else normal))

    def __repr__(self) -> str:
        return f"<wall {self.name!r} at {self.point}>"
