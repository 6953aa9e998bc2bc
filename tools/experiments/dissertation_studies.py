"""The dissertation's experiments, lived again on its author's published sessions."""

import numpy

import plots
from lab import Run
from published import DISSERTATION, PUBLISHED_KEYS, REFERENCE
from report import table
from summaries import binned, curve, mean, mean_over_users, of_sessions

WAYS = {  # name: (policy, queries)
    "adaptive": ("adaptive", "all"), "adaptive, aof": ("adaptive", "aof"), "oain": ("oain", "aof"),
    "count": ("count", "aof"), "random-scene": ("random-scene", "aof"), "random": ("random", "aof"),
}
RATES = (0.1, 0.25, 0.5, 1, 2, 5)


def seeds(lab):
    return range(1, 3 if lab.quick else 6)


def live_ways(lab, what, scenario, ways=WAYS):
    """Outcomes by way, a list over seeds."""
    runs = [Run(scenario, policy, queries, seed=seed) for policy, queries in (WAYS[way] for way in ways)
            for seed in seeds(lab)]
    lived = iter(lab.live(what, runs))
    return {way: [next(lived) for _ in seeds(lab)] for way in ways}


def row(name, runs):
    """Mean, first session, sessions 2-5, sessions 15-20."""
    outcomes = [outcome for run in runs for outcome in run]
    stretches = (of_sessions(outcomes, *stretch) for stretch in ((1, 20), (1, 1), (2, 5), (15, 20)))
    return [name, *(f"{mean(stretch):.2f}" for stretch in stretches)]


def published_outcomes(outcomes, key):
    return [{**outcome, "questions": outcome["published"][key]} for outcome in outcomes]


CURVES_TEXT = """\
A fresh user for each intention, 20 sessions each. *Constant scenes*: the first scene of each of the author's users, 20
times (ours: his files of that experiment are not at hand, so nothing published stands beside it). *Position changes*
and *objects and positions change* (his "simultaneous changes"): his sessions as published, groups 1 and 2 with 9
intentions in all. Seeds decide ties and chance; means over {seeds} seeds."""
LIVES_TEXT = """\
One user lives a group's intentions (5 in group 1, 4 in group 2; a user for each of the author's two files): one after
another; in blocks of 20 sessions in an order of chance; at random ({seeds} shuffles). Below them, harder than the
dissertation: one user lives both groups' nine intentions. The published column is the design's reference for the
dissertation's network on all four groups and in the author's own orders, which are not at hand: compare with `oain`."""
HEADER = ["", "mean", "session 1", "sessions 2-5", "sessions 15-20"]


def learning_curves(lab, report, sessions):
    scenes = {
        "constant scenes": lab.write("constant", sessions.constant()),
        "position changes": lab.write("position", sessions.as_published("position")),
        "objects and positions change": lab.write("objects", sessions.as_published("objects")),
    }
    figure, axes = plots.panels(3, sharey=True)
    parts = [CURVES_TEXT.format(seeds=len(seeds(lab))), "The dissertation's means over all four groups: " + ", ".join(
        f"{what} {figure}" for what, figure in DISSERTATION.items()) + "."]
    number = numpy.arange(1, 21)
    for axis, (title, scenario) in zip(axes, scenes.items()):
        lived = live_ways(lab, f"learning curves, {title}", scenario)
        rows = []
        for way, runs in lived.items():
            plots.line(axis, number, *curve(runs), name=way)
            rows.append(row(f"`{way}`", runs))
            key = PUBLISHED_KEYS.get(way)
            if key and "published" in runs[0][0]:
                told = [published_outcomes(runs[0], key)]
                plots.line(axis, number, curve(told)[0], name=way, label=f"{way}, published", dashed=True)
                rows.append(row(f"{way}, published", told))
        axis.set(title=title, xlabel="session", xticks=(1, 5, 10, 15, 20))
        parts.append(f"**{title[0].upper() + title[1:]}**\n\n" + table(HEADER, rows))
    plots.count_scale(axes[0])
    axes[0].set_ylabel("questions")
    plots.legend_below(figure, axes[2], 4)
    parts.insert(1, plots.save(figure, report, "learning-curves", "Questions against session number"))
    report.section("Learning curves", *parts)
    goals_of_published(lab, report, scenes)


def goals_of_published(lab, report, scenes):
    both = [scenes["position changes"], scenes["objects and positions change"]]
    lived = {queries: [outcome for run in lab.live("published sessions", [
        Run(scenario, queries=queries, seed=seed) for scenario in both for seed in seeds(lab)]) for outcome in run]
        for queries in ("aof", "all")}
    report.goal("published, aof", "published sessions, mean questions; action, object and full", mean(lived["aof"]))
    report.goal("published, all", "same, all question families", mean(lived["all"]))
    report.goal("first session", "same, first session alone", mean(of_sessions(lived["all"], 1, 1)))
    report.goal("sessions 15-20", "same, sessions 15-20", mean(of_sessions(lived["all"], 15, 20)))


def oain_fidelity(lab, report, sessions):
    scenarios = {kind: lab.write(kind, sessions.as_published(kind)) for kind in ("position", "objects")}
    rows, apart = [], []
    for kind, scenario in scenarios.items():
        runs = lab.live(f"oain against the published counts, {kind}",
                        [Run(scenario, "oain", "aof", seed=seed) for seed in seeds(lab)])
        for group in (1, 2):
            cells = [outcome["questions"] - outcome["published"]["OAIN"] for run in runs for outcome in run
                     if outcome["user"].startswith(f"group{group}")]
            rows.append([f"group {group}, {kind}", len(cells) // len(runs), *differences(cells)])
            apart += cells
    rows.append(["**all**", len(apart) // len(seeds(lab)), *differences(apart)])
    report.goal("oain difference", "policy `oain` against the published counts, mean absolute difference",
                float(numpy.mean(numpy.abs(apart))))
    figure, (axis,) = plots.panels(1, width=5, height=2.8)
    steps = numpy.arange(min(apart), max(apart) + 1)
    axis.bar(steps, [100 * numpy.mean(numpy.array(apart) == step) for step in steps], color=plots.VERMILION, width=0.7)
    axis.set(xlabel="our questions minus the published ones", ylabel="sessions, %", xticks=steps)
    axis.grid(axis="x", visible=False)
    report.section(
        "The dissertation's network, reproduced",
        "Policy `oain` against the interactions that the author's result files give for each of his sessions, over "
        f"{len(seeds(lab))} seeds. Ties are broken by chance, in his program as in ours, so that not all can agree.",
        table(["sessions", "cells", "mean abs. difference", "mean difference", "exact"], rows),
        plots.save(figure, report, "oain-fidelity", "Difference to the published counts"))


def differences(cells):
    cells = numpy.array(cells)
    return [f"{numpy.mean(numpy.abs(cells)):.3f}", f"{numpy.mean(cells):+.3f}", f"{100 * numpy.mean(cells == 0):.0f} %"]


def several_intentions(lab, report, sessions):
    """Continual users and group learning."""
    together = [(1, 2)]
    lives = {
        "continual": [lab.write("continual", sessions.continual())],
        "blocks": [lab.write(f"blocks-{s}", sessions.in_blocks(s)) for s in seeds(lab)],
        "random": [lab.write(f"random-{s}", sessions.at_random(s)) for s in seeds(lab)],
        "both groups, blocks": [lab.write(f"blocks-both-{s}", sessions.in_blocks(s, together)) for s in seeds(lab)],
        "both groups, random": [lab.write(f"random-both-{s}", sessions.at_random(s, together)) for s in seeds(lab)],
    }
    words = {"continual": "continual users", "blocks": "group learning, blocks of 20",
             "random": "group learning, at random", "both groups, blocks": "nine intentions, blocks of 20",
             "both groups, random": "nine intentions, at random"}
    ways = ("adaptive", "adaptive, aof", "oain", "count")
    lived, rows = {}, []
    for life, scenarios in lives.items():
        runs = iter(lab.live(words[life], [Run(scenario, *WAYS[way], seed=seed)
                             for way in ways for seed, scenario in enumerate(scenarios, 1)]))
        lived[life] = {way: [next(runs) for _ in scenarios] for way in ways}
        rows.append([words[life], *(f"{mean([o for run in lived[life][way] for o in run]):.2f}" for way in ways),
                     REFERENCE.get(life, "")])
    for life in ("continual", "blocks", "random"):
        report.goal(life, words[life], mean([o for run in lived[life]["adaptive"] for o in run]))
    report.section(
        "Several intentions in one life", LIVES_TEXT.format(seeds=len(seeds(lab))),
        table(["mean questions", *(f"`{way}`" for way in ways), "dissertation, published"], rows),
        plot_lives(report, lived, ways))


def plot_lives(report, lived, ways):
    figure, axes = plots.panels(2, width=6, sharey=True)
    for axis, life, title, width in (
            (axes[0], "both groups, blocks", "nine intentions in blocks of 20: each session", 1),
            (axes[1], "both groups, random", "nine intentions at random: means of 5 sessions", 5)):
        for way in ways[:3]:
            lives = [outcome for run in lived[life][way] for outcome in run]
            plots.line(axis, *binned(lives, width), name=way, marker=False)
        axis.set(title=title, xlabel="session", xticks=range(0, 181, 20))
    plots.count_scale(axes[0])
    axes[0].set_ylabel("questions")
    plots.legend_below(figure, axes[0], 3)
    return plots.save(figure, report, "group-learning", "Questions while nine intentions are lived")


def learning_rates(lab, report, sessions):
    if not lab.offers("evaluate", "--lambda"):
        report.skip("learning rates", "this beckon-intention has no `evaluate --lambda`")
        return
    scenario = lab.write("objects", sessions.as_published("objects"))
    lives = lab.write("random-1", sessions.at_random(1))
    figure, (axis,) = plots.panels(1, width=5.5)
    rows = []
    for rate, colour in zip(RATES, plots.shades(len(RATES))):
        told = ("--lambda", str(rate))
        runs, mixed = (lab.live(f"learning rate {rate}, {path.stem}", [
            Run(path, "oain", "aof", seed=seed, more=told) for seed in seeds(lab)]) for path in (scenario, lives))
        plots.line(axis, numpy.arange(1, 21), curve(runs)[0], colour=colour, label=f"λ = {rate:g}")
        rows.append([*row(f"{rate:g}", runs), f"{mean_over_users(mixed)[0]:.2f}"])
    told = published_outcomes(runs[0], "OAIN")
    plots.line(axis, numpy.arange(1, 21), curve([told])[0], label="published, λ = 1", dashed=True)
    plots.count_scale(axis, (1, 2, 3, 5, 8))
    axis.set(xlabel="session", ylabel="questions", xticks=(1, 5, 10, 15, 20))
    plots.legend_below(figure, axis, 4)
    report.section(
        "Learning rates of the dissertation's network",
        "Policy `oain`, objects and positions changing; f_TT += λ after a session, then the factor is normalised. The "
        "last column is group learning at random, where what was learnt has to be outvoted.",
        table(["λ", *HEADER[1:], "at random"], rows),
        plots.save(figure, report, "learning-rates", "Questions against session number by learning rate"))
