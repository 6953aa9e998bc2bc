"""The methods side by side on clouds whose truth is known."""

import numpy

import plots
from pose.clouds import judge
from pose.lab import WAYS, Fit, machine
from pose.published import KEYS, PROGRAMS
from pose.summaries import cells, good, headings, pair_of, shares, values
from report import table

KINDS = ("box", "cylinder", "ellipsoid", "mixed")
TEXT = """\
{count} clouds of each set from seeds {seeds}. *Clear*: sensor noise and quantisation. *Hard*: besides, depth that errs
over whole regions, flying and missing pixels at edges, the lowest 8 mm lost, a table that is off by 0.5° and 2 mm, and
about every third cloud cropped, which no method is told. `multiscale, smoothed` is the multi-scale fit with the
smoothing of its authors' program (`[multiscale] smooth_m = 0.03`). Times are those of a machine with {machine}."""


def side_by_side(lab, report, clouds):
    """Scores by (set, way)."""
    fitted = []
    for way in WAYS:
        for kind in ("clear", "hard"):
            sets = [made for made in clouds.sets if made.kind == kind]
            poses = lab.fit(f"{way}, {kind} clouds", [Fit(made.clouds, way, lab.repeats(way)) for made in sets])
            fitted += [((kind, way), made, told) for made, told in zip(sets, poses)]
    scores = judge(lab, "clear and hard clouds", fitted)
    seeds = sorted({made.seed for made in clouds.sets})
    parts = [TEXT.format(count=len(scores["clear", "adaptive"]), seeds=", ".join(map(str, seeds)), machine=machine()),
             plot_positions(report, scores)]
    for kind in ("clear", "hard"):
        parts.append(f"**{kind[0].upper() + kind[1:]}**\n\n" + table_of(kind, scores))
    parts += ["By seed:\n\n" + table_by(scores, "seed", seeds),
              "By kind of shape:\n\n" + table_by(scores, "kind", KINDS), plot_kinds(report, scores)]
    report.section("The methods side by side", *parts)
    goals(report, scores)
    return scores


def table_of(kind, scores):
    rows = []
    for way in WAYS:
        told = scores[kind, way]
        converged = sum(score["pose"]["converged"] for score in told)
        rows.append([f"`{way}`", *cells(told, KEYS), *cells(told, ("radial_mm",)), good(told),
                     f"{converged} of {len(told)}"])
    for program, (pairs, of_60) in PROGRAMS[kind].items():
        figures = (f"{middle:g} / {tail:g}" for middle, tail in pairs)
        rows.append([f"{program}, published", *figures, "", f"{of_60} of 60", ""])
    return table(["", *headings(KEYS), *headings(("radial_mm",)), "good", "says converged"], rows)


def table_by(scores, key, cases):
    rows = []
    for kind, case in ((kind, case) for kind in ("clear", "hard") for case in cases):
        told = {way: [score for score in scores[kind, way] if score[key] == case] for way in WAYS}
        if told["adaptive"]:
            rows += [[kind, case, *headings([figure]), *(cells(told[way], [figure])[0] for way in WAYS)]
                     for figure in KEYS[1:]]
            rows.append([kind, case, "good", *(good(told[way]) for way in WAYS)])
    return table(["set", key, "", *(f"`{way}`" for way in WAYS)], rows)


def plot_positions(report, scores):
    figure, axes = plots.panels(2, width=5, sharey=True)
    for axis, kind in zip(axes, ("clear", "hard")):
        for way in WAYS:
            axis.step(*shares(values(scores[kind, way], "position_mm")), where="post", color=plots.STYLES[way][0],
                      label=way)
        for program, (pairs, _) in PROGRAMS[kind].items():
            style = plots.PROGRAMS[program]
            axis.plot(pairs[KEYS.index("position_mm")], (50, 95), linestyle="--", color=style[0], marker=style[1],
                      label=f"{program}, published: median, p95")
        axis.set(title=kind, xlabel="position error, mm", xscale="log", xlim=(0.05, 100), ylim=(0, 101))
        plots.plain_numbers(axis.xaxis, (0.1, 0.3, 1, 3, 10, 30, 100))
    axes[0].set_ylabel("clouds with at most this error, %")
    plots.legend_below(figure, axes[0], 3)
    return plots.save(figure, report, "position", "Distribution of the position error by method")


def plot_kinds(report, scores):
    figure, axes = plots.panels(2, width=5.4, rows=2, height=2.9)
    for axis, (key, kind) in zip(axes, [(key, kind) for key in ("position_mm", "iou") for kind in ("clear", "hard")]):
        for place, way in enumerate(WAYS):
            groups = [[score[key] for score in scores[kind, way] if score["kind"] == case and not score["failed"]]
                      for case in KINDS]
            at = numpy.arange(len(KINDS)) + 0.16 * (place - (len(WAYS) - 1) / 2)
            plots.boxes(axis, groups, at, 0.13, plots.STYLES[way][0], way)
        axis.set(title=f"{kind}: " + ("position error, mm" if key == "position_mm" else "IoU"))
        axis.set_xticks(range(len(KINDS)), KINDS)
        axis.grid(axis="x", visible=False)
        if key == "position_mm":
            axis.set_yscale("log")
            plots.plain_numbers(axis.yaxis, (0.1, 0.3, 1, 3, 10, 30))
    plots.legend_below(figure, axes[0], 3)
    return plots.save(figure, report, "kinds", "Position error and IoU by kind of shape and method")


def goals(report, scores):
    for kind in ("clear", "hard"):
        told = scores[kind, "adaptive"]
        for key, name, tail, digits in (("position_mm", "position, mm", "p95", 2), ("iou", "IoU", "p5", 3)):
            for part, figure in zip(("median", tail), pair_of(told, key)):
                report.goal(f"{kind} {key} {part}", f"{kind} set, {name}, {part}", float(figure), digits=digits,
                            at_least=key == "iou")
    times = pair_of(scores["clear", "adaptive"] + scores["hard", "adaptive"], "time_ms")
    for part, figure in zip(("median", "p95"), times):
        report.goal(f"time {part}", f"time an object, ms, clear and hard sets, {part}", float(figure))
