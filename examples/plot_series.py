#!/usr/bin/env python3
"""Draws columns of a run's series.csv over time, as an SVG that every browser opens. Needs Python alone.

usage: plot_series.py SERIES COLUMN... > plot.svg
       plot_series.py SERIES                        lists the columns
"""
import csv
import math
import sys

COLOURS = ["#1f77b4", "#d62728", "#2ca02c", "#9467bd", "#ff7f0e", "#17becf", "#8c564b", "#7f7f7f"]
WIDTH, HEIGHT, LEFT, RIGHT, TOP, BOTTOM = 760, 420, 90, 20, 40, 50


def ticks(lowest, highest):
    """About five round numbers that lie within the range."""
    raw = (highest - lowest) / 5
    power = 10.0 ** math.floor(math.log10(raw))
    step = next(power * factor for factor in (1, 2, 5, 10) if power * factor >= raw)
    return [n * step for n in range(math.ceil(lowest / step), math.floor(highest / step) + 1)]


def limits(values):
    lowest, highest = min(values), max(values)
    return (lowest, highest) if lowest < highest else (lowest - 1.0, highest + 1.0)


def svg(times, columns):
    """@param columns  {name: values}; empty cells are None"""
    x_limits = limits(times)
    y_limits = limits([y for values in columns.values() for y in values if y is not None])

    def place(x, y):
        return (LEFT + (WIDTH - LEFT - RIGHT) * (x - x_limits[0]) / (x_limits[1] - x_limits[0]),
                HEIGHT - BOTTOM - (HEIGHT - TOP - BOTTOM) * (y - y_limits[0]) / (y_limits[1] - y_limits[0]))

    parts = []
    for x in ticks(*x_limits):
        at = place(x, y_limits[0])[0]
        parts.append(f'<path d="M{at:.1f},{TOP}V{HEIGHT - BOTTOM}" stroke="#ddd"/>'
                     f'<text x="{at:.1f}" y="{HEIGHT - BOTTOM + 18}" text-anchor="middle">{x:.6g}</text>')
    for y in ticks(*y_limits):
        at = place(x_limits[0], y)[1]
        parts.append(f'<path d="M{LEFT},{at:.1f}H{WIDTH - RIGHT}" stroke="#ddd"/>'
                     f'<text x="{LEFT - 8}" y="{at + 4:.1f}" text-anchor="end">{y:.6g}</text>')
    parts.append(f'<text x="{(LEFT + WIDTH - RIGHT) / 2}" y="{HEIGHT - 10}" text-anchor="middle">time [s]</text>')
    for n, (name, values) in enumerate(columns.items()):
        colour = COLOURS[n % len(COLOURS)]
        places = [place(x, y) for x, y in zip(times, values) if y is not None]
        parts.append(f'<polyline points="{" ".join(f"{x:.1f},{y:.1f}" for x, y in places)}" fill="none" '
                     f'stroke="{colour}" stroke-width="2"/>'
                     f'<text x="{LEFT + 150 * n}" y="22" font-weight="bold" fill="{colour}">{name}</text>')
    return (f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {WIDTH} {HEIGHT}" font-family="sans-serif" '
            f'font-size="12"><rect width="{WIDTH}" height="{HEIGHT}" fill="white"/>\n' + "\n".join(parts) + "\n</svg>")


def main():
    if len(sys.argv) < 2 or sys.argv[1] in ("-h", "--help"):
        sys.exit(__doc__)
    with open(sys.argv[1], encoding="utf-8", newline="") as file:
        header, *rows = csv.reader(file)
    names = sys.argv[2:]
    unknown = [name for name in names if name not in header]
    if unknown or not names:
        sys.exit((f"no column '{unknown[0]}'; " if unknown else "") + "columns: " + " ".join(header))
    values = {name: [float(row[header.index(name)]) if row[header.index(name)] else None for row in rows]
              for name in names}
    times = [float(row[header.index("time")]) for row in rows]
    print(svg(times, values))


main()
