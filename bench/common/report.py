"""Tables and result files."""
import json
import os
import shlex
import statistics
import sys

import machine

BUSY = 0.2  # cores that others may use
PLACES = ("--data", "--barchan", "--mpich", "--work", "--out")


def median(values):
    return statistics.median(values)


def mean(values):
    return statistics.fmean(values)


def spread(values):
    """Largest less smallest over the median."""
    return (max(values) - min(values)) / median(values) if len(values) > 1 else 0.0


def number(value, digits=3):
    """A number as people read it: 3 significant digits, thousands apart, a dash for none."""
    if value is None:
        return "–"
    if isinstance(value, str):
        return value
    if isinstance(value, int):
        return f"{value:,}"
    if value != 0 and (abs(value) >= 10**digits):
        return f"{value:,.0f}"
    return f"{value:#.{digits}g}".rstrip(".")


def table(head, rows):
    """A Markdown table; first column left, others right."""
    cells = [[number(cell) for cell in row] for row in rows]
    widths = [max(len(row[c]) for row in [head, *cells]) for c in range(len(head))]
    rule = ["-" * max(3, widths[0])] + ["-" * max(2, w - 1) + ":" for w in widths[1:]]

    def line(row):
        aligned = [row[0].ljust(widths[0])] + [cell.rjust(w) for cell, w in zip(row[1:], widths[1:])]
        return "| " + " | ".join(aligned) + " |"

    return "\n".join([line(head), "| " + " | ".join(rule) + " |", *[line(row) for row in cells]]) + "\n"


def command_line(script):
    """The script with its arguments, but without folders and files, which mean nothing elsewhere."""
    words, before = [script], ""
    for word in sys.argv[1:]:
        if before not in PLACES and word.split("=")[0] not in PLACES:
            words.append(word)
        before = word
    return shlex.join(words)


def heading(title, command, repetitions):
    """First lines of a result: what, on which machine, of which commit, how."""
    m = machine.describe()
    caches = ", ".join(f"{name} {size}" for name, size in m["caches"].items())
    virtual = "" if m["virtual"] == "no" else f", virtual ({m['virtual']})"
    others = machine.load_of_others()
    note = ("the machine was idle otherwise" if others < BUSY else
            "**the machine was busy with other work: figures are rough**")
    return (f"# {title}\n\n"
            f"{m['processor']} (family {m['family']}, model {m['model']}), {m['cores']} cores{virtual}; {caches}; "
            f"{m['memory_gib']} GiB; {' '.join(m['flags'])}.\n"
            f"{m['compiler']}; {m['mpi']}. Commit {machine.commit()}.\n"
            f"Command: `{command}`; repetitions: {repetitions}; others used {others:.2f} cores meanwhile: {note}.\n\n")


def write(folder, name, data, markdown):
    """Writes NAME.json and NAME.md into the folder. Returns the paths."""
    os.makedirs(folder, exist_ok=True)
    paths = [os.path.join(folder, f"{name}.{kind}") for kind in ("json", "md")]
    with open(paths[0], "w") as file:
        json.dump({"machine": machine.describe(), "commit": machine.commit(), "load_of_others": round(machine.load_of_others(), 3), **data},
                  file, indent=1)
        file.write("\n")
    with open(paths[1], "w") as file:
        file.write(markdown)
    return paths


def results_folder(given, work, quick):
    """Where results go: as asked, else bench/results/MACHINE; those of quick runs never go there by themselves."""
    if given:
        return given
    if quick:
        return os.path.join(work, "results")
    return os.path.join(machine.SOURCE, "bench", "results", machine.slug())
