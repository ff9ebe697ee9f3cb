"""What a step takes on many ranks, from what was measured on few.

A rank is a brick of equal particles. In a step it works on its interior while messages to its links travel, then on its rim:

    end(s) = max( begin(s) + interior, max over links [ end of the link (s - 1) + delay + wire ] ) + rim + messages

where begin(s) is end(s - 1), or later where a rebuild or a reduction is waited for. Interior and rim come from the work of a particle
and step, and from geometry: pairs across a cut are computed on both sides. Imbalance lasts, noise is drawn anew in every step.
Times are microseconds, lengths widths of a cell (the reach of the contact search).
"""
import math
from dataclasses import dataclass

import numpy

SHAPES = {"strips": 1, "pencils": 2, "bricks": 3}


@dataclass(frozen=True)
class Problem:
    """What was measured of a packing on one rank."""
    name: str
    dimension: int
    row: float             # of a particle and step, without rebuilds
    rebuild: float         # of a particle and rebuild
    rebuild_every: float   # steps
    fixed: float           # of a step, whatever there is to do
    per_cell: float        # particles in a cube, or square, one cell wide
    ghost_bytes: float     # that travel for a ghost and step
    migrant_bytes: float = 400.0


@dataclass(frozen=True)
class Network:
    """Between two ranks."""
    name: str
    delay: float           # of a short message, one way
    rate: float            # bytes in a microsecond that a rank can send
    message: float         # of the processor, for a message sent and one received
    round: float           # of a reduction, for each doubling of the ranks


@dataclass(frozen=True)
class Spread:
    """How ranks differ."""
    imbalance: float = 0.03   # lasting: uniform up to this share of the interior, the threshold of recuts
    noise: float = 0.01       # of each step: exponential, this share on average


@dataclass(frozen=True)
class Brick:
    """A rank's part: particles, edges [cells], and at how many of the two sides of each edge another rank is."""
    particles: float
    edges: tuple
    sides: tuple
    links: int

    def grown(self, by):
        """Volume with `by` cells more at each side where another rank is."""
        return math.prod(max(0.0, edge + sides * by) for edge, sides in zip(self.edges, self.sides))

    @property
    def volume(self):
        return math.prod(self.edges)

    @property
    def ghosts(self):
        return self.particles * (self.grown(1) / self.volume - 1)

    @property
    def rim(self):
        """Share of the rows that wait for ghosts."""
        return 1 - self.grown(-1) / self.volume

    @property
    def surplus(self):
        """Pairs that are computed twice, over all: those that cross a face."""
        crossing = 3 / 8 if len(self.edges) == 3 else 4 / (3 * math.pi)  # of pairs within the reach, a face each cell
        return crossing * sum(sides / 2 / edge for edge, sides in zip(self.edges, self.sides))


def factors(ranks, axes):
    """Ranks as a product of `axes` numbers as near to each other as can be, the largest first."""
    if axes == 1:
        return (ranks,)
    best = max(f for f in range(1, round(ranks ** (1 / axes)) + 1) if ranks % f == 0)
    return (*factors(ranks // best, axes - 1), best)


def brick(problem, particles, ranks, shape):
    """A rank's part of a cube (or square) of particles; None where a strip would be thinner than two cells, a brick than one."""
    axes = min(SHAPES[shape], problem.dimension)
    counts = [*sorted(factors(ranks, axes), reverse=True), *[1] * (problem.dimension - axes)]
    side = (particles * ranks / problem.per_cell) ** (1 / problem.dimension)
    edges = tuple(side / n for n in counts)
    least = 2 if shape == "strips" else 1
    if any(n > 1 and edge < least for n, edge in zip(counts, edges)):
        return None
    links = math.prod(min(n, 3) for n in counts) - 1  # of the ranks that have most
    return Brick(particles, edges, tuple(min(n, 3) - 1 for n in counts), links)


def grid(ranks, shape, dimension):
    axes = min(SHAPES[shape], dimension)
    return (*factors(ranks, axes), *[1] * (3 - axes))


@dataclass(frozen=True)
class Step:
    """Parts of a step of one rank."""
    interior: float
    rim: float
    messages: float
    arrival: float       # after the neighbour's end
    rebuild: float
    migration: float     # arrival of a rebuild's messages
    reduction: float


def parts(problem, network, share, ranks):
    """@param share  Brick"""
    work = problem.row * share.particles * (1 + share.surplus)
    rim = work * share.rim
    ghost_bytes = share.ghosts * problem.ghost_bytes
    bulk = share.ghosts * problem.migrant_bytes
    return Step(work - rim + problem.fixed, rim, share.links * network.message, network.delay + ghost_bytes / network.rate,
                problem.rebuild * (share.particles + share.ghosts), network.delay + bulk / network.rate,
                0.0 if ranks == 1 else network.round * math.ceil(math.log2(ranks)))


def neighbour_most(values, shape):
    """For each rank the largest value among itself and all that touch it; the grid has no ends."""
    most = values.reshape(shape)
    for axis, count in enumerate(shape):
        if count > 1:
            most = numpy.maximum(most, numpy.maximum(numpy.roll(most, 1, axis), numpy.roll(most, -1, axis)))
    return most.ravel()


def simulate(problem, network, spread, share, shape, rebuilds=4, seed=1, lag=2):
    """Mean time of a step of all ranks in a grid of `shape`, over that number of rebuilds."""
    random = numpy.random.default_rng(seed)
    ranks = math.prod(shape)
    p = parts(problem, network, share, ranks)
    slow = 1 + spread.imbalance * random.random(ranks) if ranks > 1 else numpy.ones(1)
    end, answer = numpy.zeros(ranks), None
    rebuild_every = max(1, round(problem.rebuild_every))
    check_every, steps = max(1, rebuild_every // 8), rebuilds * rebuild_every
    for step in range(1, steps + 1):
        begin = end
        if answer is not None and step == answer[0]:
            begin = numpy.maximum(begin, answer[1])
            answer = None
        noisy = 1 + (random.exponential(spread.noise, ranks) if spread.noise > 0 else 0.0)
        interior = begin + p.interior * slow * noisy
        if ranks > 1:
            interior = numpy.maximum(interior, neighbour_most(end, shape) + p.arrival)
        end = interior + p.rim * slow + p.messages
        if step % check_every == 0 and ranks > 1:
            answer = (step + lag, float(end.max()) + p.reduction)
        if step % rebuild_every == 0:
            if ranks > 1:  # migrants, then ghosts
                end = numpy.maximum(end, neighbour_most(end, shape) + p.migration)
            end = end + p.rebuild * slow
            if ranks > 1:
                end = numpy.maximum(end, neighbour_most(end, shape) + p.migration)
    return float(end.mean()) / steps


def predict(problem, network, spread, particles, ranks, shape):
    """Microseconds a step with so many particles a rank; None where the cuts do not fit."""
    share = brick(problem, particles, ranks, shape)
    if share is None:
        return None
    return simulate(problem, network, spread, share, grid(ranks, shape, problem.dimension))
