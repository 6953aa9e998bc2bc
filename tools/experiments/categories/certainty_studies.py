"""Whether confidence is worth something: risk over coverage, claims against what came true, and strange things."""

import numpy

import plots
from categories.figures import UNKNOWN, calibration_error, mean_interval, reliability, surest
from categories.sets import TITLES, WAYS, pooled
from report import table

STYLES = {"dissertation": plots.STYLES["oain"], "default": plots.STYLES["adaptive"]}
COVERAGES = (0.5, 0.6, 0.7, 0.8, 0.9, 1.0)
CERTAINTY_TEXT = """\
Above: the share of wrong names among the surest views, against how many those are; the mark is T: right of it the
user is asked. Below: ten bins of equal count by the probability of what is said, and how often that came true; on the
diagonal claims are worth what they say, below it they are too bold."""
COVERAGE_TEXT = "Accuracy of the surest views, dissertation → **default**; and of those not asked about at T."
STRANGE_TEXT = """\
Rendered strange things (books, tools, hands, crockery without a category, fruit, gadgets, toys, cloth; the
generator's own, but of seeds that are not trained on) and views of known categories. *Named*: as one of the
categories, right or wrong, unasked; of strange things that is the harm. *Called Unknown*: rightly or wrongly,
*unasked* of those. Brackets: 95 % over things."""


def certainty(report, judged):
    by_way = {way: {name: one.known() for name, one in pooled(judged, cues).items()} for way, cues in WAYS.items()}
    names = list(by_way["default"])
    rows = []
    for name in names:
        pairs = [(surest(by_way["dissertation"][name], share), surest(by_way["default"][name], share))
                 for share in COVERAGES]
        at_t = [at_threshold(by_way[way][name]) for way in WAYS]
        rows.append([TITLES[name], *("{:.3f} → **{:.3f}**".format(*pair) for pair in pairs),
                     "{} → **{}**".format(*at_t)])
    report.section("Risk and coverage, claim and truth", CERTAINTY_TEXT, plot_certainty(report, by_way, names),
                   COVERAGE_TEXT, table(["views", *(f"{100 * share:.0f} %" for share in COVERAGES), "at T (of views)"],
                                        rows))


def at_threshold(judged):
    told = ~judged.asked
    return f"{judged.right[told].mean():.3f} ({100 * told.mean():.0f} %)" if told.any() else "none"


def plot_certainty(report, by_way, names):
    figure, axes = plots.panels(len(names), width=3.6, height=3.0, rows=2)
    for column, name in enumerate(names):
        above, below = axes[column], axes[len(names) + column]
        below.plot((0, 1), (0, 1), color="#777777", linewidth=1)
        for way, judged in by_way.items():
            colour, marker = STYLES[way]
            one = judged[name]
            wrong = ~one.right[numpy.argsort(-one.confidence, kind="stable")]
            share = numpy.arange(1, len(one) + 1) / len(one)
            risk = numpy.cumsum(wrong) / numpy.arange(1, len(one) + 1)
            above.plot(share, risk, color=colour, label=way)
            at = int((~one.asked).sum())
            if at:
                above.plot(share[at - 1], risk[at - 1], color=colour, marker=marker, markersize=8, clip_on=False,
                           zorder=4)
            _, claim, truth = reliability(one).T
            below.plot(claim, truth, color=colour, marker=marker, label=f"{way}: {calibration_error(one):.3f}")
        above.set(title=TITLES[name], xlabel="share of views told", ylabel="wrong of those" if not column else "",
                  xlim=(0, 1), ylim=(0, None))
        below.set(xlabel="probability claimed", ylabel="came true" if not column else "", xlim=(0, 1), ylim=(0, 1.02))
        below.legend(fontsize=8, title="calibration error", title_fontsize=8)
    plots.legend_below(figure, axes[0], len(by_way))
    return plots.save(figure, report, "certainty", "Risk over coverage, and reliability, of both")


def strange_things(report, judged):
    rows = []
    groups = [("strange, any depth camera", "rendered any", True), ("strange, Kinect", "rendered kinect", True)]
    groups += [(f"known: {TITLES[name]}", name, False) for name in pooled(judged, "all")]
    for title, name, strange in groups:
        for way, cues in WAYS.items():
            one = judged[name, cues].strange() if strange else pooled(judged, cues)[name].known()
            unknown = one.predicted == UNKNOWN
            rows.append([title if way == "dissertation" else "", len(one), way,
                         *(share(one, which) for which in (~unknown & ~one.asked, unknown, unknown & ~one.asked,
                                                          one.asked))])
    strange = judged["rendered any", "all"].strange()
    named = strange.only((strange.predicted != UNKNOWN) & ~strange.asked)
    whose = ", ".join(f"{name} {count}" for name, count in zip(*numpy.unique(named.predicted, return_counts=True)))
    report.section("Strange things", STRANGE_TEXT,
                   table(["views", "number", "cues", "named", "called Unknown", "unasked", "asked about"], rows),
                   f"What they are named by all cues (any depth camera): {whose or 'nothing'}.")


def share(judged, which):
    low, high = mean_interval(judged, which, 400)
    return f"{100 * which.mean():.1f} % ({100 * low:.0f}-{100 * high:.0f})"
