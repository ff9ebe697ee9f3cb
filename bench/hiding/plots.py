"""Plots of the sweep as SVG, drawn here: no module is needed."""
import os

import tables

COLOURS = ["#1f77b4", "#d62728", "#2ca02c", "#9467bd", "#ff7f0e", "#17becf", "#8c564b", "#7f7f7f"]
WIDTH, HEIGHT, LEFT, RIGHT, TOP, BOTTOM = 760, 420, 70, 220, 40, 50


def nice_step(span):
    """A step of 1, 2 or 5 times a power of ten that cuts the span into about five."""
    raw = max(span, 1e-12) / 5
    power = 10 ** len(str(int(raw))) / 10 if raw >= 1 else 1.0
    while power > raw:
        power /= 10
    return next(power * factor for factor in (1, 2, 5, 10) if power * factor >= raw)


class Plot:
    """One frame with lines. @param lines  [(name, [(x, y), …], dashed, colour)]"""

    def __init__(self, title, xlabel, ylabel, lines, most=None):
        self.title, self.xlabel, self.ylabel, self.lines = title, xlabel, ylabel, lines
        xs = [x for _, points, _, _ in lines for x, _ in points]
        ys = [y for _, points, _, _ in lines for _, y in points]
        self.x_most, self.y_most = max(xs) or 1.0, most or 1.05 * max(ys)

    def place(self, x, y):
        return (LEFT + (WIDTH - LEFT - RIGHT) * x / self.x_most,
                HEIGHT - BOTTOM - (HEIGHT - TOP - BOTTOM) * min(y, self.y_most) / self.y_most)

    def axes(self):
        parts = []
        for most, is_x in ((self.x_most, True), (self.y_most, False)):
            step = nice_step(most)
            for n in range(int(most / step + 1e-9) + 1):
                x, y = self.place(n * step, 0) if is_x else self.place(0, n * step)
                text = f"{n * step:,.10g}"
                if is_x:
                    parts.append(f'<path d="M{x:.1f},{TOP}V{HEIGHT - BOTTOM}" class="grid"/>'
                                 f'<text x="{x:.1f}" y="{HEIGHT - BOTTOM + 18}" text-anchor="middle">{text}</text>')
                else:
                    parts.append(f'<path d="M{LEFT},{y:.1f}H{WIDTH - RIGHT}" class="grid"/>'
                                 f'<text x="{LEFT - 8}" y="{y + 4:.1f}" text-anchor="end">{text}</text>')
        middle = (HEIGHT - BOTTOM + TOP) / 2
        return parts + [
            f'<text x="{(LEFT + WIDTH - RIGHT) / 2}" y="{HEIGHT - 10}" text-anchor="middle">{self.xlabel}</text>',
            f'<text x="16" y="{middle}" text-anchor="middle" transform="rotate(-90 16 {middle})">{self.ylabel}</text>',
            f'<text x="{LEFT}" y="22" font-weight="bold">{self.title}</text>']

    def line(self, n, name, points, dashed, colour):
        places = " ".join(f"{x:.1f},{y:.1f}" for x, y in (self.place(*p) for p in points))
        dash = ' stroke-dasharray="6 4"' if dashed else ""
        marks = "".join(f'<circle cx="{x:.1f}" cy="{y:.1f}" r="3" fill="{colour}"/>'
                        for x, y in (self.place(*p) for p in points))
        y = TOP + 10 + 18 * n
        return (f'<polyline points="{places}" fill="none" stroke="{colour}" stroke-width="2"{dash}/>{marks}'
                f'<path d="M{WIDTH - RIGHT + 12},{y}h24" stroke="{colour}" stroke-width="2"{dash}/>'
                f'<text x="{WIDTH - RIGHT + 42}" y="{y + 4}">{name}</text>')

    def svg(self):
        body = self.axes() + [self.line(n, *line) for n, line in enumerate(self.lines)]
        return (f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {WIDTH} {HEIGHT}" font-family="sans-serif" '
                f'font-size="12"><style>.grid{{stroke:#ddd;fill:none}}</style>'
                f'<rect width="{WIDTH}" height="{HEIGHT}" fill="white"/>\n' + "\n".join(body) + "\n</svg>\n")


def look(names, program, schedule):
    return schedule == "sequential", COLOURS[names.index(program) % len(COLOURS)]


def step_times(groups, size, particles, names):
    lines = []
    for (of_size, program, schedule), by_delay in groups.items():
        points = sorted((d, tables.median_of(ms, "step_us")) for d, ms in by_delay.items() if d not in (None, tables.EVEN))
        if of_size == size and points:
            lines.append((tables.name_of(program, schedule), points, *look(names, program, schedule)))
    if not lines:
        return None
    return Plot(f"{particles:,} disks, two ranks", "one-way delay [µs]", "step [µs]", lines)


def hidden_shares(groups, delay, names):
    """Hidden share against the work of a step, over all sizes."""
    lines = {}
    for (_, program, schedule), by_delay in groups.items():
        if delay not in by_delay or tables.median_of(by_delay[delay], "hidden") is None:
            continue
        point = (tables.median_of(by_delay[delay], "work_us"), 100 * tables.median_of(by_delay[delay], "hidden"))
        lines.setdefault((program, schedule), []).append(point)
    if not lines:
        return None
    return Plot(f"at {delay} µs one way", "work of a step [µs]", "hidden of the time in flight [%]",
                [(tables.name_of(*key), sorted(points), *look(names, *key)) for key, points in lines.items()], most=105)


def draw(found, folder):
    """Writes the plots. Returns their paths."""
    groups = tables.group(found)
    names = list(dict.fromkeys(program for _, program, _ in groups))
    drawn = {}
    for size in dict.fromkeys(m["size"] for m in found):
        particles = next(m["particles"] for m in found if m["size"] == size)
        drawn[f"hiding_step_{size}.svg"] = step_times(groups, size, particles, names)
    for delay in dict.fromkeys(m["delay_us"] for m in found):
        if delay is not None:
            drawn[f"hiding_share_{delay}us.svg"] = hidden_shares(groups, delay, names)
    paths = []
    for name, plot in drawn.items():
        if plot is None:
            continue
        paths.append(os.path.join(folder, name))
        with open(paths[-1], "w") as file:
            file.write(plot.svg())
    return paths
