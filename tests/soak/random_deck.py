"""A random deck that runs in a second or two: text, and how many steps it has."""

import math

RADIUS = 0.05


class RandomDeck:
    """Draws the parts of a deck one after the other; the order of the draws is what a seed repeats."""

    def __init__(self, rng):
        self.rng = rng
        self.dimension = rng.choice((2, 2, 3))
        self.lines = []
        self.cell = 2 * RADIUS * rng.uniform(1.0, 1.3)
        self.draw_domain()
        self.draw_materials()
        self.draw_bonds()
        self.draw_stages()
        self.draw_walls()
        self.draw_particles()
        self.draw_run()

    def vector(self, values):
        return "[" + ", ".join(f"{v:.17g}" for v in list(values)[: self.dimension]) + "]"

    def table(self, header, **entries):
        self.lines.append(header)
        for key, value in entries.items():
            if value is None:
                continue
            text = value if isinstance(value, str) else ("true" if value is True else f"{value:.17g}")
            self.lines.append(f"{key} = {text}")

    def direction(self):
        v = [self.rng.gauss(0, 1) for _ in range(self.dimension)] + [0.0]
        norm = math.sqrt(sum(c * c for c in v)) or 1.0
        return [c / norm for c in v[:3]]

    def draw_domain(self):
        rng = self.rng
        long = rng.randint(12, 40) if self.dimension == 2 else rng.randint(10, 20)
        short = [rng.randint(5, 12) if self.dimension == 2 else rng.randint(5, 6) for _ in range(2)]
        axes = [long, *short]
        if rng.random() < 0.2:
            axes[0], axes[1] = axes[1], axes[0]
        self.size = [n * self.cell for n in axes]
        self.outside = rng.choice(("error", "error", "delete"))
        self.is_closed = rng.random() < (0.3 if self.outside == "delete" else 0.95)
        self.plate = rng.random() < 0.4  # across the middle of the longest axis
        self.periodic = [rng.random() < 0.3 for _ in range(self.dimension)]
        names = [f'"{"xyz"[a]}"' for a in range(self.dimension) if self.periodic[a]]
        pull = rng.choice((0.0, 2.0, 9.81, 40.0))
        self.lines.append(f"dimension = {self.dimension}")
        self.lines.append("gravity = " + self.vector(pull * c for c in self.direction()))
        self.table("[domain]", lo=self.vector([0.0] * 3), hi=self.vector(self.size),
                   periodic="[" + ", ".join(names) + "]", outside=f'"{self.outside}"',
                   strip_axis='"' + rng.choice(("longest", "longest", "x", "y")) + '"')

    def draw_materials(self):
        rng = self.rng
        self.materials = ["a", "b", "c"][: rng.randint(1, 3)]
        self.density = rng.choice((100.0, 1000.0, 2500.0))
        self.most_friction = 0.0
        self.has_rolling_stiffness = rng.random() < 0.5  # else the tangential one, which may be zero
        self.stiffest, self.mass = 0.0, self.density * math.pi * (0.6 * RADIUS) ** 2
        if self.dimension == 3:
            self.mass *= 4 / 3 * 0.6 * RADIUS
        self.is_hertz = self.dimension == 3 and rng.random() < 0.4
        self.is_by_radius = not self.is_hertz and rng.random() < 0.25
        self.has_heat = rng.random() < 0.25
        self.rolls = rng.random() < 0.4
        self.is_jkr = self.is_hertz and rng.random() < 0.25
        sticks = self.is_hertz and not self.is_jkr
        self.adhesion = rng.choice((None, None, "dmt", "sjkr", "sjkr2", "bridge")) if sticks else None
        kind = rng.choice(("normal_damping", "normal_damping_rate", "restitution"))
        for name in self.materials:
            kn = 10 ** rng.uniform(4, 5.5)
            friction = rng.choice((0.0, 0.3, 1.0))
            self.most_friction = max(self.most_friction, friction)
            self.stiffest = max(self.stiffest, kn)
            constants = (self.hertz(kn) if self.is_hertz else
                         self.by_radius(kn) if self.is_by_radius else self.linear(kn, kind))
            if self.has_heat:
                constants |= {"conductivity": rng.uniform(0.1, 1.0), "heat_capacity": 1000.0}
            self.table("[[material]]", name=f'"{name}"', density=self.density, friction=friction,
                       rolling_friction=rng.choice((0.01, 0.2)) if self.rolls else None,
                       rolling_damping=(None if self.has_rolling_stiffness else 0.5) if self.rolls else None,
                       rolling_stiffness=0.3 * kn if self.rolls and self.has_rolling_stiffness else None, **constants)
        if len(self.materials) > 1 and rng.random() < 0.4:
            constants = {"restitution": 0.4} if self.is_hertz or self.is_by_radius else {
                "normal_stiffness": self.stiffest, "normal_damping": 0.1 * math.sqrt(self.stiffest * self.mass)}
            self.table("[[pair]]", materials='["a", "b"]', friction=0.2, **constants)
        if self.adhesion == "bridge":
            self.table("[[bridge]]", materials=f'["a", "{rng.choice(self.materials)}"]', contact_angle=rng.choice((None, 40.0)),
                       surface_tension=1e-5 * self.stiffest, volume=(rng.uniform(0.05, 0.3) * RADIUS) ** 3)
        twists = self.dimension == 3 and self.rolls and self.most_friction > 0.0 and rng.random() < 0.5
        self.table("[contact]", no_tension=rng.choice(("true", "false")),
                   model=('"jkr"' if self.is_jkr else '"hertz"') if self.is_hertz else None,
                   pull_off=rng.choice((None, '"peak"')) if self.is_jkr else None,
                   tangential=rng.choice((None, '"mindlin-displacement"')) if self.is_hertz else None,
                   rolling='"spring"' if self.rolls else None,
                   twisting='"marshall"' if twists else None,
                   stiffness='"radius"' if self.is_by_radius else None,
                   adhesion=f'"{self.adhesion}"' if self.adhesion else None)
        if self.has_heat:
            self.table("[heat]", dissipation=rng.choice(("true", "false")))

    def linear(self, kn, kind):
        rng = self.rng
        critical = 2 * math.sqrt(kn * self.mass)
        damping = {"normal_damping": rng.uniform(0, 0.4) * critical,
                   "normal_damping_rate": rng.uniform(0, 0.4) * critical / self.mass,
                   "restitution": rng.uniform(0.3, 1.0)}[kind]
        return {"normal_stiffness": kn, "tangential_stiffness": rng.choice((0.0, rng.uniform(0.1, 1.0) * kn)),
                "tangential_damping": rng.choice((None, 0.1 * critical)), kind: damping}

    def by_radius(self, kn):
        rng = self.rng
        return {"young_modulus": kn / RADIUS, "restitution": rng.uniform(0.3, 1.0),
                "tangential_stiffness_ratio": rng.choice((None, 0.8)), "tangential_damping_ratio": rng.choice((None, 0.2))}

    def hertz(self, kn):
        """As stiff as kn where spheres overlap by a twentieth of a radius."""
        rng = self.rng
        return {"young_modulus": 5.5 * kn / RADIUS, "poisson_ratio": rng.choice((-0.2, 0.0, 0.3, 0.5)),
                "restitution": rng.uniform(0.3, 1.0), "tangential_damping_ratio": rng.choice((None, 0.2)),
                "surface_energy": 2e-6 * kn if self.adhesion == "dmt" or self.is_jkr else None,
                "cohesion_density": 0.1 * kn if self.adhesion in ("sjkr", "sjkr2") else None}

    def draw_bonds(self):
        rng = self.rng
        self.has_bonds = rng.random() < 0.5
        if not self.has_bonds:
            return
        area = 2 * RADIUS if self.dimension == 2 else math.pi * RADIUS ** 2
        self.table("[[bond]]", name='"glue"', normal_stiffness=0.3 * self.stiffest / area,
                   damping_ratio=rng.choice((0.0, 0.3)), radius_factor=rng.choice((0.5, 1.0)),
                   tensile_strength=rng.choice((None, 10 ** rng.uniform(-1, 3))),
                   shear_strength=rng.choice((None, 10 ** rng.uniform(-1, 3))))

    def draw_stages(self):
        rng = self.rng
        self.step = rng.uniform(0.05, 0.12) * math.sqrt(self.mass / self.stiffest)
        self.steps = rng.randint(200, 1200)
        self.num_stages = rng.choice((1, 1, 2, 3))
        for number in range(self.num_stages):
            is_last = number + 1 == self.num_stages
            self.table("[[stage]]", name=f'"stage{number + 1}"', local_damping=rng.choice((0.0, 0.0, 0.3)),
                       max_time=None if is_last else rng.uniform(0.1, 0.6) * self.steps * self.step)

    def draw_walls(self):
        rng = self.rng
        material = lambda: f'"{rng.choice(self.materials)}"'
        for axis in range(self.dimension):
            if self.periodic[axis] or not self.is_closed:
                continue
            for end in (0, 1):
                point, normal = [0.0] * 3, [0.0] * 3
                point[axis], normal[axis] = self.inner(axis)[end], 1.0 - 2.0 * end
                speed = rng.choice((0.0, 0.0, 0.0, 0.2)) * RADIUS / (self.steps * self.step)
                self.table("[[wall]]", name=f'"{"xyz"[axis]}{end}"', point=self.vector(point),
                           normal=self.vector(normal), material=material(),
                           velocity=self.vector(speed * c for c in normal) if speed else None,
                           from_stage=f'"stage{self.num_stages}"' if rng.random() < 0.1 else None)
        if self.plate:
            middle = [0.5 * c for c in self.size]
            is_loaded = rng.random() < 0.6
            across = [a for a in range(self.dimension) if a != self.long_axis()]
            extents = [4 * RADIUS for _ in across]
            for place, a in enumerate(across):
                if self.periodic[a]:  # maybe through the border, maybe without ends
                    middle[a] *= rng.choice((0.0, 0.3, 1.0, 1.97))
                    extents[place] = rng.choice((4 * RADIUS, 4 * RADIUS, 0.9 * self.size[a], self.size[a]))
            speed = rng.choice((0.0, 0.3)) * RADIUS / (self.steps * self.step)
            self.table("[[wall]]", name='"plate"', kind='"plate"', point=self.vector(middle),
                       normal=self.vector(float(a == self.long_axis()) for a in range(3)), material=material(),
                       width=extents[0], depth=extents[1] if self.dimension == 3 else None,
                       velocity=None if is_loaded else self.vector(speed * rng.gauss(0, 1) for _ in range(3)),
                       load=rng.uniform(0, 100) if is_loaded else None,
                       mass=20 * self.mass if is_loaded else None,
                       damping=rng.choice((0.0, 1.0)) if is_loaded else None)

    def long_axis(self):
        return max(range(self.dimension), key=lambda a: self.size[a])

    def inner(self, axis):
        """Where particles may be: where there are walls, they stand a cell within the domain."""
        margin = 0.0 if self.periodic[axis] or not self.is_closed else self.cell
        return margin, self.size[axis] - margin

    def draw_particles(self):
        rng, axis = self.rng, self.long_axis()
        begin, end = self.inner(axis)
        middle, gap = 0.5 * self.size[axis], self.cell
        if self.plate:
            stretches = [(begin, middle - gap), (middle + gap, end)]
        else:
            cut = begin + rng.uniform(0.3, 1.0) * (end - begin)
            stretches = [(begin, cut), (cut, end)]
        stretches = [s for s in stretches if s[1] - s[0] > 2.5 * self.cell]
        if len(stretches) > 1 and rng.random() < 0.4:
            stretches.pop(rng.randrange(2))
        for stretch in stretches:
            ranges = [self.inner(a) for a in range(self.dimension)] + [(0.0, 0.0)]
            ranges[axis] = stretch
            self.draw_source([r[0] for r in ranges], [r[1] for r in ranges])

    def draw_source(self, lo, hi):
        rng = self.rng
        pace = rng.choice((0.0, 0.002, 0.006)) * RADIUS / self.step
        common = {"material": f'"{rng.choice(self.materials)}"',
                  "velocity": self.vector(pace * c for c in self.direction())}
        region = f"{{ lo = {self.vector(lo)}, hi = {self.vector(hi)} }}"
        if rng.random() < 0.15:
            middle = [0.5 * (a + b) for a, b in zip(lo, hi)]
            common["fixed"] = f"{{ lo = {self.vector(lo)}, hi = {self.vector(middle)} }}"
        if self.has_bonds and rng.random() < 0.7:
            self.table("[[particles]]", kind='"lattice"', region=region, radius=RADIUS, spacing=2 * RADIUS,
                       bond='"glue"', **common)
        elif rng.random() < 0.35:
            self.table("[[particles]]", kind='"packing"', region=region,
                       radius=f"[{0.7 * RADIUS:.17g}, {RADIUS:.17g}]",
                       solid_fraction=0.45 if self.dimension == 3 else 0.7, seed=rng.randint(1, 99), **common)
        else:
            arrangement = ("square", "hexagonal") if self.dimension == 2 else ("cubic", "fcc")
            self.table("[[particles]]", kind='"lattice"', region=region, arrangement=f'"{rng.choice(arrangement)}"',
                       radius=f"[{rng.uniform(0.6, 1.0) * RADIUS:.17g}, {RADIUS:.17g}]",
                       spacing=2 * RADIUS * rng.choice((1.0, 1.02, 1.2)), jitter=rng.uniform(0, 1),
                       seed=rng.randint(1, 99), **common)

    def draw_run(self):
        rng = self.rng
        self.table("[time]", step=self.step, steps=self.steps, allow_unstable=True)
        if rng.random() < 0.5:
            self.table("[search]", skin=rng.uniform(0.05, 0.8) * RADIUS)
        if rng.random() < 0.5:
            self.table("[limits]", overlap_warning=rng.choice((0.0, 0.02, 0.1)),
                       overlap_error=rng.choice((0.0, 0.15, 0.5)))
        self.table("[output]", series_every=rng.randint(10, 60), snapshots_every=rng.choice((0, 100)),
                   energy=rng.choice(("true", "false")), picture="false")

    def text(self):
        return "\n".join(self.lines) + "\n"
