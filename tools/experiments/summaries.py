"""From outcomes to figures: means with confidence intervals, rates with Wilson's interval, percentiles."""

import math

import numpy

Z95 = 1.96


def mean(outcomes, key="questions"):
    return float(numpy.mean([outcome[key] for outcome in outcomes]))


def by_user(outcomes, key="questions"):
    """Values of each user's sessions, in order."""
    users = {}
    for outcome in outcomes:
        users.setdefault(outcome["user"], []).append(outcome[key])
    return users


def of_sessions(outcomes, first, last):
    return [outcome for outcome in outcomes if first <= outcome["session"] <= last]


def curve(runs, key="questions"):
    """Mean by session number and half the width of its 95 % interval over users; seeds are averaged first.

    `runs`: outcomes of the same users with different seeds.
    """
    table = numpy.array([list(by_user(run, key).values()) for run in runs], dtype=float).mean(axis=0)
    half = Z95 * table.std(axis=0, ddof=1) / math.sqrt(len(table)) if len(table) > 1 else numpy.zeros(table.shape[1])
    return table.mean(axis=0), half


def mean_over_users(runs, key="questions"):
    """Mean of the users' means and half the width of its 95 % interval."""
    means = [numpy.mean(values) for run in runs for values in by_user(run, key).values()]
    half = Z95 * numpy.std(means, ddof=1) / math.sqrt(len(means)) if len(means) > 1 else 0.0
    return float(numpy.mean(means)), float(half)


def wilson(times, of):
    """Wilson's 95 % interval of a rate, as fractions (E. B. Wilson, JASA 22, 1927)."""
    if of == 0:
        return 0.0, 1.0
    rate, z2 = times / of, Z95 * Z95
    centre = (rate + z2 / (2 * of)) / (1 + z2 / of)
    half = Z95 / (1 + z2 / of) * math.sqrt(rate * (1 - rate) / of + z2 / (4 * of * of))
    return max(0.0, centre - half), min(1.0, centre + half)


class Errors:
    """How sessions under noise ended."""

    def __init__(self, runs):
        outcomes = [outcome for run in runs for outcome in run]
        self.sessions = len(outcomes)
        self.questions = mean(outcomes)
        self.wrong = sum(outcome["answered"] is not None and not outcome["correct"] for outcome in outcomes)
        self.unanswered = sum(outcome["answered"] is None for outcome in outcomes)

    def wrong_rate(self):
        return self.wrong / self.sessions

    def wrong_interval(self):
        return wilson(self.wrong, self.sessions)


def binned(outcomes, width, key="questions"):
    """Middles of bins of `width` sessions, means over users in each, half the width of their 95 % intervals."""
    users = numpy.array(list(by_user(outcomes, key).values()), dtype=float)
    bins = users.shape[1] // width
    table = users[:, :bins * width].reshape(len(users), bins, width).mean(axis=2)
    half = Z95 * table.std(axis=0, ddof=1) / math.sqrt(len(table))
    return numpy.arange(bins) * width + (width + 1) / 2, table.mean(axis=0), half
