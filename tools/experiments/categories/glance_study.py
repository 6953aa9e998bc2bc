"""The dissertation's cues beside all of them: the figures with their intervals, and what is taken for what."""

import numpy

import plots
from categories.figures import FIGURES, SEED, UNKNOWN, figures, gain, intervals, together
from categories.published import BEST_KNOWN, JUDGED, LEVELS
from categories.sets import WAYS, pooled
from report import table

TEXT = """\
*Macro recall*: mean over categories. *Surest 70 %*: accuracy of the views with the highest confidence. *Asks about*:
share at or below T, where the user is asked. *Calibration error*: mean difference of claim and truth in 10 bins of
equal count by probability of what is said; of few views even a perfect model shows some. Known categories only; what
has no answer, or is called Unknown, is wrong. In brackets: 95 % by bootstrap over products, not views ({resamples}
resamples, seed {seed}; calibration errors, which resampling makes larger, moved by their mean excess)."""
CONFUSIONS_TEXT = """\
Rows: what it is; columns: what it is taken for; shares of the row in colour, views in numbers. Real views and
rendered meshes together."""


def glance(report, sets, judged, resamples):
    rows = []
    for name, views in sets.by_name.items():
        for way, cues in WAYS.items():
            one = judged[name, cues]
            rows.append([views.title if way == "dissertation" else "", len(one.known()), way,
                         *with_intervals(figures(one), intervals(one, resamples))])
    rows += [[which, 166, "", *told, "", ""] for which, told in BEST_KNOWN.items()]
    gains = []
    for name, views in sets.by_name.items():
        more = gain(judged[name, "all"], judged[name, "dissertation"], resamples)
        gains.append("{}: {:+.3f} ({:+.3f} .. {:+.3f})".format(views.title, *more))
    report.section("At a glance", TEXT.format(resamples=resamples, seed=SEED), sets.words(),
                   table(["views", "number", "cues", *FIGURES], rows),
                   "Accuracy, default less dissertation, of the same views: " + "; ".join(gains) + ".")


def with_intervals(measured, limits):
    return [f"{100 * value:.0f} % ({100 * low:.0f}-{100 * high:.0f})" if name == "asks about" else
            f"{value:.3f} ({low:.2f}-{high:.2f})" for name, value, low, high in zip(FIGURES, measured, *limits)]


def goals(report, judged, resamples, ms):
    for name, one in pooled(judged, "all").items():
        if name not in JUDGED:
            continue
        measured, (low, high) = figures(one), intervals(one, resamples)
        for figure in LEVELS:
            at = FIGURES.index(figure)
            report.goal(f"{name} {figure}", f"{JUDGED[name]}, {figure}", measured[at],
                        f"{measured[at]:.2f} ({low[at]:.2f}-{high[at]:.2f})", at_least=True)
    report.goal("time", "ms an object, all cues, median", ms, digits=1)


def confusions(report, judged):
    names = [name for name in judged if name[0] == "objects" or name[0].startswith("meshes")]
    if not names:
        report.skip("confusions", "neither real views nor meshes are at hand")
        return
    both = {way: together([judged[name] for name in names if name[1] == cues]) for way, cues in WAYS.items()}
    parts = [CONFUSIONS_TEXT, plot_confusions(report, both)]
    for way, one in both.items():
        parts.append(f"Commonest, {way}: " + ", ".join(commonest(one)) + ".")
    report.section("What is taken for what", *parts)


def counts_of(judged, names):
    at = {name: i for i, name in enumerate(names)}
    counts = numpy.zeros((len(names), len(names)), int)
    numpy.add.at(counts, ([at[name] for name in judged.category], [at[name] for name in judged.predicted]), 1)
    return counts


def commonest(judged, most=6):
    names = sorted({*judged.category, *judged.predicted})
    counts = counts_of(judged, names)
    numpy.fill_diagonal(counts, 0)
    order = numpy.argsort(-counts, axis=None, kind="stable")[:most]
    return [f"{names[i]} taken for {names[j]} {counts[i, j]}" for i, j in
            zip(*numpy.unravel_index(order, counts.shape)) if counts[i, j]]


def plot_confusions(report, both):
    names = sorted({name for one in both.values() for name in (*one.category, *one.predicted)} - {UNKNOWN}) + [UNKNOWN]
    figure, axes = plots.panels(len(both), width=5.2, height=4.4)
    for axis, (way, one) in zip(axes, both.items()):
        counts = counts_of(one, names)[:-1]  # nothing here is Unknown
        shares = counts / numpy.maximum(counts.sum(1, keepdims=True), 1)
        axis.pcolormesh(shares, cmap="Blues", vmin=0, vmax=1, edgecolors="white", linewidth=0.5)
        for row, column in zip(*numpy.nonzero(counts)):
            axis.text(column + 0.5, row + 0.5, counts[row, column], ha="center", va="center", fontsize=7,
                      color="white" if shares[row, column] > 0.6 else "black")
        axis.set_xticks(numpy.arange(len(names)) + 0.5, names, rotation=60, ha="right", fontsize=8)
        axis.set_yticks(numpy.arange(len(names) - 1) + 0.5, names[:-1], fontsize=8)
        axis.invert_yaxis()
        axis.grid(False)
        axis.set_title(f"{way}: {one.right.mean():.2f} right of {len(one)}")
    return plots.save(figure, report, "confusions", "Confusion matrices of the dissertation's cues and of all")
