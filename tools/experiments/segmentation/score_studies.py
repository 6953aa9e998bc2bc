"""How well both paths find the objects of real scenes, of the embedded scene's frames and of crowded tables."""

import numpy

import plots
from report import table
from segmentation.lab import PATHS
from segmentation.scores import HEADINGS, THRESHOLDS, cells, curves, of_path

GLANCE_TEXT = """\
{sentence} *Ratio*: median over the scenes of the reference's time over the fast path's, both measured one after the
other."""
TEXTS = {
    "real": """\
{scenes} table scenes of the Object Segmentation Database, Kinect, 640x480. Truth: whole objects, drawn by its
authors.""",
    "embedded": """\
{scenes} frames of the embedded scene (`beckon-capture --render`; seeds {seeds}). Its objects stand 3 mm apart or more,
none on another, none mostly hidden, in a room with walls and a floor.""",
    "crowded": """\
{scenes} tables of boxes, cylinders, open vessels and balls, in a room, through a camera with the noise, quantisation,
shadows and lost edges of structured light. *Touching*: slid until they meet, half of the boxes side to side. *Stacked*:
most stand on another. *Occluded*: most stand 1-6 cm behind another. *Mixed*: all of that, 11-17 things.""",
}
TITLES = {"real": "Real scenes", "embedded": "Frames of the embedded scene", "crowded": "Crowded tables"}


def glance(report, scorer, judged, segmented):
    """`judged` and `segmented`: by set."""
    rows, said = [], []
    for name, scores in judged.items():
        told = {path: scorer.summary([score.counts for score in of_path(scores, path)]) for path in PATHS}
        times, ratio = times_of(segmented[name])
        rows.append([TITLES[name].lower(), len(scores) // len(PATHS), told["fast"]["regions"],
                     *(both(told, lambda one, key=key: f"{one[key]:.3f}") for key in ("f1_50", "f1_75")),
                     both(told, lambda one: one["under_segmented"]), both(told, lambda one: one["missed"]),
                     f"{times['reference']:.0f} → {times['fast']:.1f}", f"{ratio:.0f}"])
        f1 = both(told, lambda one: f"{one['f1_50']:.2f}")
        said.append(f"{f1} on {TITLES[name].lower()}")
    sentence = f"F1 at IoU .5, reference → fast: {'; '.join(said)}."
    header = ["reference → **fast**", "scenes", "objects", "F1 .5", "F1 .75", "merges", "missed", "time, ms", "ratio"]
    report.section("Both paths at a glance", GLANCE_TEXT.format(sentence=sentence), plot(report, judged),
                   table(header, rows))


def both(told, show):
    return f"{show(told['reference'])} → **{show(told['fast'])}**"


def times_of(segmented):
    """Median of each path over the scenes, ms; median of their ratios."""
    times = {path: numpy.array([told.total_ms for (_, of), told in segmented.items() if of == path]) for path in PATHS}
    return ({path: float(numpy.median(ms)) for path, ms in times.items()},
            float(numpy.median(times["reference"] / times["fast"])))


def section(report, scorer, name, scores, segmented, **said):
    kinds = list(dict.fromkeys(scene.kind for scene, _ in scores))
    rows = []
    for kind in (kinds if len(kinds) > 1 else []) + [None]:
        for path in PATHS:
            chosen = of_path(scores, path, kind)
            objects = sum(score.counts["regions"] for score in chosen)
            rows.append([kind or "**all**", len(chosen), objects, f"`{path}`", *cells(scorer, chosen)])
    parts = [TEXTS[name].format(scenes=len(scores) // len(PATHS), **said),
             table(["", "scenes", "objects", "", *HEADINGS], rows)]
    no_table = [f"{scene.name}, `{path}`: {told.reason}" for (scene, path), told in segmented.items() if told.reason]
    if no_table:
        parts.append("No table was seen in: " + "; ".join(no_table) + ".")
    report.section(TITLES[name], *parts)


def plot(report, judged):
    figure, axes = plots.panels(len(judged), width=3.9, sharey=True)
    for axis, (name, scores) in zip(axes, judged.items()):
        for path in PATHS:
            colour, _ = plots.STYLES[path]
            precision, recall, f1 = curves(of_path(scores, path))
            axis.plot(THRESHOLDS, f1, color=colour, linewidth=2.4, label=f"{path}: F1")
            axis.plot(THRESHOLDS, precision, color=colour, linewidth=1, linestyle=":", label=f"{path}: precision")
            axis.plot(THRESHOLDS, recall, color=colour, linewidth=1, linestyle="--", label=f"{path}: recall")
        axis.set(title=TITLES[name], xlabel="IoU from which an object is found", ylim=(0, 1.02))
    plots.legend_below(figure, axes[0], 2)
    return plots.save(figure, report, "f1", "F1, precision and recall of both paths against the IoU threshold")


def goals(report, scorer, judged, segmented):
    for name, prefix in (("real", ""), ("crowded", "crowded ")):
        if name not in judged:
            continue
        scores = of_path(judged[name], "fast")
        told = scorer.summary([score.counts for score in scores])
        for key, words in (("f1_50", "F1 at IoU .5"), ("f1_75", "F1 at IoU .75"), ("mean_iou", "mean IoU")):
            report.goal(prefix + key, f"{TITLES[name].lower()}, {words}", told[key], digits=3, at_least=True)
        if name == "real":
            report.goal("merges", f"{TITLES[name].lower()}, merges in 65 scenes' worth",
                        65 * told["under_segmented"] / len(scores))
    name = "real" if "real" in judged else next(iter(judged))
    times, ratio = times_of(segmented[name])
    report.goal("ratio", f"{TITLES[name].lower()}, times faster than the reference, same run", ratio, at_least=True)
    report.goal("time_ms", f"{TITLES[name].lower()}, ms a 640x480 frame, median", times["fast"])
