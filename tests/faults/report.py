"""Table of a campaign and its verdict. Pure: results in, text and failed bars out.

A result is the dictionary that campaign.py writes for each fault as a line of JSON."""
import math

import plan

CONFIDENCE = 0.95


def percentile(values, share):
    """The smallest value that at least this share of the values does not exceed."""
    ordered = sorted(values)
    return ordered[max(0, math.ceil(share * len(ordered)) - 1)] if ordered else math.nan


def upper_bound(failures, count):
    """Upper end of the 95 % confidence interval of the probability of a failure (Clopper and Pearson). For no failure
    it is about 3 / count, the rule of three."""
    if failures >= count:
        return 1.0
    low, high = 0.0, 1.0
    for _ in range(60):
        middle = (low + high) / 2
        at_most = sum(math.comb(count, k) * middle**k * (1 - middle)**(count - k) for k in range(failures + 1))
        low, high = (middle, high) if at_most > 1 - CONFIDENCE else (low, middle)
    return high


def _row(name, results):
    outages = [result["outage_s"] for result in results]
    restored = [result["recovered_after_s"] for result in results if result["recovered"]]
    return (f"{name:<24}{len(results):>6}{sum(not result['recovered'] for result in results):>9}"
            f"{percentile(outages, 0.5):>8.2f}{percentile(outages, 0.99):>8.2f}{max(outages):>8.2f}"
            f"{percentile(restored, 0.5):>10.2f}{percentile(restored, 0.99):>8.2f}")


def _is_data_path_kill(result):
    first = result["injections"][0]
    return result["group"] == "kill" and first["arguments"]["service"] in plan.DATA_PATH


def _of_time(name, values, limit_s, is_judged):
    p99 = percentile(values, 0.99)
    return {"bar": name, "count": len(values), "value": f"{p99:.2f} s" if values else "no fault",
            "limit": f"{limit_s:g} s" if is_judged else f"{limit_s:g} s on a quiet machine, not judged here",
            "passed": not is_judged or not values or p99 <= limit_s}


def _of_zero(name, results, is_failure, value):
    failures = [result for result in results if is_failure(result)]
    bound = upper_bound(len(failures), len(results)) if results else 1.0
    return {"bar": name, "count": len(results), "value": value(results), "limit": "0",
            "interval": f"{len(failures)} of {len(results)} faults; below {100 * bound:.2g} % with 95 % confidence",
            "passed": not failures}


def _seconds(*names):
    return (lambda result: any(result["false_s"][name] > 0 for name in names),
            lambda results: f"{sum(result['false_s'][name] for result in results for name in names):.2f} s")


def judge(results, bars, with_times=True):
    """Every bar with its value; the campaign has passed if each of them has. `with_times`: also those of outages."""
    count_of = lambda key: (lambda result: bool(result[key]), lambda all_: str(sum(len(x[key]) for x in all_)))
    return [
        _of_zero("false AVAILABLE, misaligned radar", results, *_seconds("available_misaligned")),
        _of_zero("false AVAILABLE, no data", results, *_seconds("available_silent", "pipeline_available")),
        _of_zero("false MISALIGNED", results, *_seconds("misaligned")),
        _of_zero("lost persisted states", results, *count_of("lost_states")),
        _of_zero("not recovered", results, lambda result: not result["recovered"],
                 lambda all_: str(sum(not result["recovered"] for result in all_))),
        _of_zero("crashes, other findings", results, *count_of("findings")),
        _of_time("outage p99, all faults", [x["outage_s"] for x in results], bars.outage_p99_s,
                 with_times),
        _of_time("outage p99, data-path kill", [x["outage_s"] for x in results if _is_data_path_kill(x)],
                 bars.data_path_kill_p99_s, with_times),
        _of_time("outage p99, RouDi", [x["outage_s"] for x in results if x["group"] in ("kill_roudi", "stop_roudi")],
                 bars.roudi_s, with_times),
    ]


def failures(results, bars, with_times=True):
    """(result, what is wrong) of each fault that is a reason why the campaign fails."""
    for result in results:
        wrong = [f"{name} {seconds} s" for name, seconds in result["false_s"].items() if seconds > 0]
        wrong += result["lost_states"] + result["findings"]
        if not result["recovered"]:
            wrong.append(f"not recovered: {result['state']}")
        limit_s = bars.data_path_kill_p99_s if _is_data_path_kill(result) else bars.outage_p99_s
        if with_times and result["outage_s"] > limit_s:
            wrong.append(f"outage {result['outage_s']:.2f} s")
        if wrong:
            yield result, wrong


def text(results, bars, seed, load, with_times=True):
    """`load`: busy cores on average, cores, and the load average of the last five minutes."""
    lines = [f"campaign of seed {seed}: {len(results)} faults; {load[0]:.2f} busy cores of {load[1]}, "
             f"load average {load[2]:.1f}", "",
             f"{'':<24}{'':>6}{'not':>9}{'outage, s':>24}{'recovered, s':>18}",
             f"{'fault':<24}{'count':>6}{'recov.':>9}{'median':>8}{'p99':>8}{'max':>8}{'median':>10}{'p99':>8}"]
    for group in sorted({result["group"] for result in results}):
        lines.append(_row(group, [result for result in results if result["group"] == group]))
    lines += [_row("all", results), ""]
    for bar in judge(results, bars, with_times):
        lines.append(f"[{'ok' if bar['passed'] else 'MISSED'}] {bar['bar']}: {bar['value']} of {bar['count']} "
                     f"(limit {bar['limit']}) {bar.get('interval', '')}".rstrip())
    found = list(failures(results, bars, with_times))
    if found:
        lines += ["", "faults with findings, and how to replay them:"]
    for result, wrong in found:
        lines += [f"  {result['number']}: {result['text']} (load {result['busy_cores']:.1f})",
                  *(f"      {what}" for what in wrong),
                  f"      ./tests/run faults --seed {seed} --only {result['number']}"]
    return "\n".join(lines)
