"""Trend of a series with its interval: the median of the slopes between pairs (Sen 1968), the interval by Kendall's statistic
of these pairs, with a larger variance for autocorrelated data. Pairs are at least half of the duration apart: the slope of
a single step between neighbours says nothing about the trend. Pure."""
import dataclasses
import math
import statistics

NORMAL_95 = 1.959964  # two-sided quantile
LARGEST_CORRELATION = 0.97  # beyond it, the whole series counts as two independent values or fewer


@dataclasses.dataclass(frozen=True)
class Trend:
    slope: float  # per unit of time
    lower: float  # ends of its 95 % interval
    upper: float


def distant_pairs(times):
    """(i, j) with i before j, at least half of the duration apart."""
    least = (times[-1] - times[0]) / 2
    return [(i, j) for i in range(len(times)) for j in range(i + 1, len(times)) if times[j] - times[i] >= least]


def ranks(values):
    """Ranks from 1; equal values share the mean of theirs."""
    order = sorted(range(len(values)), key=values.__getitem__)
    result = [0.0] * len(values)
    begin = 0
    while begin < len(order):
        end = begin
        while end < len(order) and values[order[end]] == values[order[begin]]:
            end += 1
        for k in order[begin:end]:
            result[k] = (begin + end + 1) / 2
        begin = end
    return result


def autocorrelation(values):
    """From one value to the next, without the bias of a short series (Kendall 1954); 0 … LARGEST_CORRELATION."""
    n = len(values)
    mean = statistics.fmean(values)
    variance = sum((v - mean) ** 2 for v in values)
    if variance == 0.0 or n < 6:
        return 0.0
    raw = sum((a - mean) * (b - mean) for a, b in zip(values, values[1:])) / variance
    return min(max((n * raw + 1.0) / (n - 4.0), 0.0), LARGEST_CORRELATION)


def variance_factor(residuals):
    """By which autocorrelation of the first order makes the variance of a mean, and of Kendall's statistic, larger; of
    ranks, so that single values do not count."""
    rho = autocorrelation(ranks(residuals))
    return (1.0 + rho) / (1.0 - rho)


def tie_factor(values):
    """By which equal values make the variance of Kendall's statistic smaller."""
    n = len(values)
    ties = [values.count(v) for v in set(values)]
    return 1.0 - sum(t * (t - 1) * (2 * t + 5) for t in ties) / (n * (n - 1) * (2 * n + 5))


def kendall_variance(n, pairs):
    """Of the sum of the signs of these pairs of n independent values. The sign of a pair is the difference of two
    independent parts with variance 1/3, which pairs share, and a rest with variance 1/3, which they do not (Hoeffding's
    decomposition). For all pairs this is n (n - 1) (2 n + 5) / 18."""
    excess = [0] * n  # pairs in which a value is the later one, less those in which it is the earlier one
    for i, j in pairs:
        excess[i] -= 1
        excess[j] += 1
    return (sum(e * e for e in excess) + len(pairs)) / 3.0


def trend_of(times, values):
    """At least three values at different times."""
    values = list(values)
    pairs = distant_pairs(times)
    slopes = sorted((values[j] - values[i]) / (times[j] - times[i]) for i, j in pairs)
    slope = statistics.median(slopes)
    residuals = [v - slope * t for t, v in zip(times, values)]
    variance = kendall_variance(len(values), pairs) * tie_factor(values) * variance_factor(residuals)
    half_width = NORMAL_95 * math.sqrt(max(0.0, variance)) / 2.0
    middle = len(slopes) / 2.0
    lower = slopes[max(0, math.floor(middle - half_width))]
    upper = slopes[min(len(slopes), math.ceil(middle + half_width)) - 1]
    return Trend(slope, min(lower, slope), max(upper, slope))
