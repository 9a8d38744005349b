"""The findings as a table. Pure."""
import judge


def _figure(value):
    return f"{value:.0f}" if abs(value) >= 1000 or float(value).is_integer() else f"{value:.2f}"


def row(found):
    if hasattr(found, "upper"):
        return (f"{found.what:<52}{_figure(found.begin):>10}{_figure(found.end):>10}"
                f"{_figure(found.lower) + ' … ' + _figure(found.upper):>20}{_figure(found.bound):>9}  {found.verdict}")
    return f"{found.what:<52}{'':>10}{_figure(found.value):>10}{'':>20}{_figure(found.bound):>9}  {found.verdict}"


def processor_time(samples):
    """Share of a core of each process over the judged part, %."""
    first, last = samples[0], samples[-1]
    duration_s = last["t_s"] - first["t_s"]
    return {name: 100 * (figures["cpu_s"] - first["processes"][name]["cpu_s"]) / duration_s
            for name, figures in last["processes"].items() if name in first["processes"]}


def text(growths, numbers, samples):
    lines = [f"{'':<52}{'begin':>10}{'end':>10}{'growth, 95 %':>20}{'bound':>9}"]
    lines += [row(found) for found in [*growths, *numbers]]
    lines.append("\nprocessor time, % of a core: " +
                 ", ".join(f"{name} {share:.1f}" for name, share in sorted(processor_time(samples).items())))
    lines.append("")
    for verdict in (judge.MET, judge.MISSED, judge.NOT_SHOWN):
        names = [found.what for found in [*growths, *numbers] if found.verdict == verdict]
        lines.append(f"{len(names)} of {len(growths) + len(numbers)} bars {verdict}"
                     + (f": {'; '.join(names)}" if names and verdict != judge.MET else ""))
    return "\n".join(lines)
