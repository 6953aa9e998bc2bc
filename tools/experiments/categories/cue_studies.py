"""Cue against cue: each by itself, the dissertation's three, all, and all but one; and what each costs."""

import numpy

import plots
from categories.figures import figures, mean_interval
from categories.lab import Test
from categories.sets import POOLED, TITLES, pooled
from report import table

TEXT = """\
Accuracy / macro recall. A cue by itself and the dissertation's three have machines of their own; all but one is the
decider of all, told that the cue saw nothing, not one that was trained without it. *ms*: median time of an object
({timed}), reading its file not counted, one process at a time; finding the object's points and frame is part of each."""


def cue_sets(names):
    """By what they are called: the argument of --cues."""
    out = {**{name: name for name in names}, "dissertation": "dissertation", "all": "all"}
    for name in names if len(names) > 2 else []:
        out[f"all but {name}"] = ",".join(other for other in names if other != name)
    return out


def cue_against_cue(lab, report, sets):
    """The median milliseconds of all cues."""
    timed = next(name for name in ("objects", "meshes kinect", "rendered kinect") if name in sets.by_name)
    chosen = cue_sets(lab.cues(sets.by_name[timed]))
    judged = sets.judge(lab, "cue against cue", list(chosen.values()), sum(POOLED.values(), []))
    by_set = {called: pooled(judged, cues) for called, cues in chosen.items()}
    ms = {called: float(numpy.median(lab.milliseconds(Test(sets.by_name[timed], cues))))
          for called, cues in chosen.items()}
    names = list(by_set["all"])
    rows = []
    for called, told in by_set.items():
        pairs = ["{:.3f} / {:.3f}".format(*figures(told[name])[:2]) for name in names]
        rows.append([f"**{called}**" if called == "all" else called, *pairs, f"{ms[called]:.1f}"])
    report.section("Cue against cue", TEXT.format(timed=TITLES[timed.split()[0]]),
                   table(["cues", *(TITLES[name] for name in names), "ms"], rows), plot_cues(report, by_set, names))
    return ms["all"]


def plot_cues(report, by_set, names):
    figure, axes = plots.panels(len(names), width=3.6, height=0.6 + 0.27 * len(by_set), sharey=True)
    called = list(by_set)[::-1]
    for axis, name in zip(axes, names):
        for place, one in enumerate(called):
            judged = by_set[one][name].known()
            low, high = mean_interval(judged, judged.right, 200)
            colour = plots.STYLES.get({"all": "adaptive", "dissertation": "oain"}.get(one), (plots.SKY, ""))[0]
            axis.barh(place, judged.right.mean(), color=colour)
            axis.plot((low, high), (place, place), color=plots.BLACK, linewidth=1)
        axis.set_yticks(range(len(called)), called)
        axis.set(title=TITLES[name], xlabel="accuracy", xlim=(0, 1))
        axis.grid(axis="y", visible=False)
    return plots.save(figure, report, "cues", "Accuracy of each cue and set of cues, with 95 % intervals")
