"""Front ends that differ: seconds a task. And how far from the best possible the questions are."""

from dataclasses import dataclass

import numpy

import plots
from lab import Run
from report import table
from scenarios import FIRST_SEED, KINDS, read
from summaries import Errors, mean, mean_over_users, of_sessions

SESSIONS = 200
SECONDS_TEXT = """\
Simulated users of all habits, {users} of each with {sessions} sessions, seed {seed}. A question takes its seconds
and those of each answer shown, "none of these" among them; a scan ends with the wanted item. A P300-like device takes
longer and is wrong in 10 % of its answers, which the policy is not told. The seconds are assumptions; what counts is
the difference between rows of equal seconds."""
REGRET_TEXT = """\
`beckon-intention regret`, {scenes} random tables of each kind, seed {seed}, answers never wrong. Given the prior, how
many seconds are expected until an accepted full query (with yes and no, questions: one second each), and how many at
best: on small tables by the exact optimum over the same families of questions, on tables of the usual size by the best
code whose words all end in yes, which may ask about any set of pairs and so is out of reach for `aof`. Boxes:
quartiles; whiskers: 5 and 95 % of the tables."""


@dataclass(frozen=True)
class FrontEnd:
    name: str
    kind: str
    options: int  # answers of a question, "none of these" among them
    question_s: float = 2.0  # to hear or read a question
    option_s: float = 0.5  # for each answer shown; of a scan: until the next is shown
    flip: float = 0.0

    def arguments(self):
        return ("--interface", self.kind, "--max-options", str(self.options),
                "--seconds-per-question", str(self.question_s), "--seconds-per-option", str(self.option_s))


FRONT_ENDS = (
    FrontEnd("yes/no switch", "yesno", 2),
    FrontEnd("choice of 4", "choice", 4), FrontEnd("choice of 6", "choice", 6), FrontEnd("choice of 8", "choice", 8),
    FrontEnd("scanner, 2 items", "scan", 2, option_s=1.0), FrontEnd("scanner, 4 items", "scan", 4, option_s=1.0),
    FrontEnd("scanner, 8 items", "scan", 8, option_s=1.0),
    FrontEnd("P300-like, 2 items", "vector", 2, option_s=1.5, flip=0.1),
    FrontEnd("P300-like, 6 items", "vector", 6, option_s=1.5, flip=0.1),
)


def interfaces(lab, report):
    if not lab.offers("evaluate", "--interface"):
        report.skip("seconds at other front ends", "this beckon-intention has no `evaluate --interface`")
        return
    users = 1 if lab.quick else 5
    scenarios = [lab.simulate(kind, users, SESSIONS, FIRST_SEED + 4) for kind in KINDS]
    rows, spans = [], []
    for front_end in FRONT_ENDS:
        runs = lab.live(f"seconds, {front_end.name}", [
            Run(scenario, flip=front_end.flip, more=front_end.arguments()) for scenario in scenarios])
        rows.append(front_end_row(front_end, f"`adaptive`, {front_end.name}", runs))
        spans.append((f"adaptive, {front_end.name}", plots.BLUE, mean_over_users(runs, "seconds")))
    switch = FRONT_ENDS[0]
    runs = lab.live("seconds, oain", [
        Run(scenario, "oain", "aof", more=switch.arguments()) for scenario in scenarios])
    rows.append(front_end_row(switch, "`oain`, yes/no switch", runs))
    spans.append(("oain, yes/no switch", plots.VERMILION, mean_over_users(runs, "seconds")))
    report.section(
        "Seconds a task at other front ends",
        SECONDS_TEXT.format(users=users, sessions=SESSIONS, seed=FIRST_SEED + 4),
        table(["", "answers shown", "s a question", "s an answer", "flipped", "**seconds a task**", "first session",
               "questions a task", "wrong"], rows),
        plot_seconds(report, spans))


def front_end_row(front_end, name, runs):
    outcomes = [outcome for run in runs for outcome in run]
    seconds, half = mean_over_users(runs, "seconds")
    return [name, f"up to {front_end.options}", front_end.question_s, front_end.option_s, f"{100 * front_end.flip:g} %",
            f"{seconds:.1f} ± {half:.1f}", f"{mean(of_sessions(outcomes, 1, 1), 'seconds'):.1f}",
            f"{mean(outcomes):.2f}", f"{100 * Errors(runs).wrong_rate():.2f} %"]


def plot_seconds(report, spans):
    figure, (axis,) = plots.panels(1, width=7, height=3.8)
    for place, (name, colour, (seconds, half)) in enumerate(spans):
        axis.barh(place, seconds, xerr=half, color=colour, height=0.65, error_kw={"capsize": 2, "elinewidth": 1})
        axis.annotate(f"{seconds:.1f}", (seconds + half, place), textcoords="offset points", xytext=(4, -3), fontsize=8)
    axis.set(yticks=range(len(spans)), yticklabels=[name for name, _, _ in spans],
             xlabel="seconds a task, mean over users")
    axis.grid(axis="y", visible=False)
    axis.invert_yaxis()
    return plots.save(figure, report, "seconds", "Seconds a task by front end")


STUDIES = (  # of regret: title, how it is answered, which best
    ("yes/no, small tables", (), "exact"),
    ("yes/no, tables of 44 pairs", (), "code"),
    ("choice of 4, small tables", FRONT_ENDS[1].arguments(), "exact"),
)


def regret(lab, report):
    if not lab.offers("regret", "--jsonl"):
        report.skip("regret", "this beckon-intention has no `regret`")
        return
    scenes = 10 if lab.quick else 100
    rows, groups = [], []
    for title, arguments, best in STUDIES:
        out = lab.folder / "regret.jsonl"
        lab.call(["regret", "--scenes", str(scenes), "--seed", str(FIRST_SEED), *arguments, "--jsonl", str(out)])
        kinds = {}
        for line in read(out):
            if line["best_of"] == best:
                kinds.setdefault((line["queries"], line["prior"]), []).append(line)
        groups.append((title, kinds))
        rows += [[title, f"`{queries}`", prior, *regret_figures(lines)] for (queries, prior), lines in kinds.items()]
        print(f"regret, {title}: {scenes} tables of {len(kinds)} kinds", flush=True)
    report.section(
        "How far from the best possible", REGRET_TEXT.format(scenes=scenes, seed=FIRST_SEED),
        plot_regret(report, groups),
        table(["", "questions", "prior", "pairs", "expected", "at best", "regret", "p95 of a table"], rows))


def regret_figures(lines):
    asked, best = (numpy.array([line[key] for line in lines]) for key in ("seconds", "best_seconds"))
    return [f"{numpy.mean([line['pairs'] for line in lines]):.0f}", f"{asked.mean():.3f}", f"{best.mean():.3f}",
            f"{100 * (asked.mean() / best.mean() - 1):.2f} %", f"{100 * numpy.percentile(asked / best - 1, 95):.1f} %"]


def plot_regret(report, groups):
    figure, axes = plots.panels(len(groups), width=4)
    for axis, (title, kinds) in zip(axes, groups):
        priors = list(dict.fromkeys(prior for _, prior in kinds))
        for queries, colour, shift in (("aof", plots.SKY, -0.18), ("all", plots.BLUE, 0.18)):
            losses = [[100 * (line["seconds"] / line["best_seconds"] - 1) for line in kinds[queries, prior]]
                      for prior in priors]
            boxes = axis.boxplot(losses, positions=numpy.arange(len(priors)) + shift, widths=0.3, whis=(5, 95),
                                 showfliers=False, patch_artist=True, medianprops={"color": plots.BLACK})
            for box in boxes["boxes"]:
                box.set(facecolor=colour, alpha=0.7)
            axis.plot([], [], color=colour, linewidth=6, alpha=0.7, label=f"questions of {queries}")
        axis.set(title=title, xticks=range(len(priors)), xticklabels=priors)
        axis.grid(axis="x", visible=False)
        axis.set_ylim(0, max(1, axis.get_ylim()[1]))
    axes[0].set_ylabel("more than at best, %")
    plots.legend_below(figure, axes[0], 2)
    return plots.save(figure, report, "regret", "Regret by prior and family of questions")
