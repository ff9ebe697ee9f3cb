"""Measurements as tables."""
import report


EVEN = "0 µs, even"


def group(found):
    """{(size, program, schedule): {delay: [measurement, …]}}, in the order of the runs. Those at 0 µs at an even price have the
    delay EVEN."""
    groups = {}
    for m in found:
        if "step_us" in m:
            delay = EVEN if m.get("even_price") else m["delay_us"]
            groups.setdefault((m["size"], m["program"], m["schedule"]), {}).setdefault(delay, []).append(m)
    return groups


def median_of(measurements, key):
    values = [m[key] for m in measurements if key in m]
    return report.median(values) if values else None


def slope(by_delay):
    """µs of step per µs of delay: least squares over all delays."""
    points = [(delay, median_of(ms, "step_us")) for delay, ms in by_delay.items() if delay not in (None, EVEN)]
    if len(points) < 2:
        return None
    mean_x = sum(x for x, _ in points) / len(points)
    mean_y = sum(y for _, y in points) / len(points)
    return sum((x - mean_x) * (y - mean_y) for x, y in points) / sum((x - mean_x) ** 2 for x, _ in points)


def name_of(program, schedule):
    return f"{program}, {schedule}" if schedule else program


def rows_of(groups, size, delays, key, form):
    for (of_size, program, schedule), by_delay in groups.items():
        if of_size != size or all(median_of(ms, key) is None for ms in by_delay.values()):
            continue
        cells = [form(median_of(by_delay[d], key)) if d in by_delay else None for d in delays]
        yield name_of(program, schedule), cells, by_delay


def percent(share):
    return None if share is None else f"{100 * share:.0f} %"


def covered(by_delay):
    """The longest delay that the work of a step is twice as long as: [delay, then for 0 µs and for 0 µs at an even price: step
    there over step here, the slope up to there]; None where there is none. Ratios are taken within a repetition."""
    work = median_of(by_delay.get(0, []), "work_us")
    delays = [d for d in by_delay if d not in (0, None, EVEN) and work and work >= 2 * d]
    if not delays:
        return None
    cells = [max(delays)]
    for here in (0, EVEN):
        pairs = list(zip(by_delay.get(here, []), by_delay[max(delays)]))
        if not pairs:
            cells += [None, None]
            continue
        cells.append(report.median([m["step_us"] / m0["step_us"] for m0, m in pairs]))
        cells.append(report.median([m["step_us"] - m0["step_us"] for m0, m in pairs]) / max(delays))
    return cells


def covered_table(groups, size):
    rows = [[name_of(program, schedule), *covered(by_delay)] for (of_size, program, schedule), by_delay in groups.items()
            if of_size == size and covered(by_delay)]
    if not rows:
        return ""
    return ("\nThe longest delay here that is at most half the work of a step, the step there over that at 0 µs, and the slope up "
            "to there. Even: at 0 µs the lab's forwarder was made to take as much of a core as at any other delay, so that what is "
            "left is the delay's.\n\n"
            + report.table(["exchange, schedule", "delay [µs]", "step over 0 µs", "slope", "step over 0 µs, even", "slope, even"], rows))


def chosen(by_delay):
    """What `auto` took, by delay."""
    return ", ".join(dict.fromkeys(ms[0]["exchange"] for ms in by_delay.values() if "exchange" in ms[0]))


def markdown(found):
    groups = group(found)
    delays = sorted({d for by_delay in groups.values() for d in by_delay}, key=lambda d: 0.5 if d == EVEN else d or 0)
    heads = ["here" if d is None else d if d == EVEN else f"{d:,} µs" for d in delays]
    text = ""
    for size in dict.fromkeys(m["size"] for m in found):
        particles = next(m["particles"] for m in found if m["size"] == size)
        text += f"## {particles:,} disks on two ranks\n\nStep [µs] by one-way delay; slope in µs of step per µs of delay.\n\n"
        rows = [[name, *cells, slope(by_delay)] for name, cells, by_delay in
                rows_of(groups, size, delays, "step_us", lambda v: v)]
        text += report.table(["exchange, schedule", *heads, "slope"], rows)
        text += covered_table(groups, size)
        text += "\nExposed [µs a step]: workers waiting for messages or inside MPI.\n\n"
        text += report.table(["exchange, schedule", *heads],
                             [[name, *cells] for name, cells, _ in rows_of(groups, size, delays, "exposed_us", lambda v: v)])
        text += "\nHidden share of the time in flight.\n\n"
        text += report.table(["exchange, schedule", *heads],
                             [[name, *cells] for name, cells, _ in rows_of(groups, size, delays, "hidden", percent)])
        for (of_size, program, schedule), by_delay in groups.items():
            if of_size == size and program == "auto":
                text += f"\n`auto`, {schedule}, took: {chosen(by_delay)}.\n"
        text += "\n"
    return text + others(found) + errors(found)


def others(found):
    """How idle the machine was in each measurement."""
    cores = [m["others"] for m in found if "others" in m]
    if not cores:
        return ""
    return (f"While a point was measured, others used {report.median(cores):.2f} cores in the median, at most {max(cores):.2f}; "
            f"in {sum(c >= report.BUSY for c in cores)} of {len(cores)} measurements {report.BUSY} or more.\n\n")


def errors(found):
    lines = {f"- {m['size']}, {m['delay_us']} µs, {name_of(m['program'], m['schedule'])}: {m['error']}"
             for m in found if "error" in m}
    return "Did not run:\n" + "\n".join(sorted(lines)) + "\n" if lines else ""
