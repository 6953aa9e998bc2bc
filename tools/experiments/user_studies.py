"""Experiments beyond the dissertation's: simulated users, wrong answers, other front ends, time."""

import numpy

import plots
from dissertation_studies import WAYS, live_ways
from hindsight import expected_questions
from interface_studies import interfaces, regret
from lab import Run
from report import table
from scenarios import FIRST_SEED, KINDS, local_simulated
from summaries import Errors, binned, mean, mean_over_users, of_sessions

FLIPS = (0.05, 0.1, 0.2)
NOISE_WAYS = ("adaptive", "adaptive, aof", "oain")
SESSIONS = 200
DATA_USERS_TEXT = """\
Users with sparse preferences that change after half of their 200 sessions; with the repeat probability they want once
more what they wanted last. Users differ much, and there are few here. The last column is an estimate for the same
sessions of what the best questions would need if the user's true preferences and repeat probability were known from
the start (`tools/experiments/hindsight.py`): where it is above a target, these users cannot reach it."""
KINDS_TEXT = """\
`beckon-intention simulate`, {users} users of each kind with {sessions} sessions, seed {seed}; `--help` tells the
habits, `services/intention/core/simulated_kinds.cpp` defines them. Tables are random (categories, instances,
distances, lateral places), about 44 pairs each. The last column: `adaptive` in the last 50 sessions. `new-every-time`
cannot be learnt: the best tree for 43 equally likely pairs needs 5.88 answers."""
NOISE_TEXT = """\
Each answer is flipped with the given probability, which no policy is told. *Wrong*: a task that was not wanted, with
Wilson's 95 % interval; *unanswered*: sessions that ended without a task. The dissertation's network believes every
answer."""
TIME_TEXT = """\
Microseconds in the policy per question, a value a session (its total divided by its questions), one process at a time
on the machine that wrote this. These figures alone change from run to run."""


def run_all(lab, report, sessions, data):
    if data:
        simulated_with_the_data(lab, report, data)
    simulated_kinds(lab, report)
    changing_wants(lab, report)
    wrong_answers(lab, report, sessions, data)
    interfaces(lab, report)
    regret(lab, report)
    time_per_question(lab, report, sessions, data)


def simulated_with_the_data(lab, report, data):
    ways = ("adaptive", "adaptive, aof", "oain", "count")
    rows = []
    for repeat, scenarios in local_simulated(data).items():
        runs = iter(lab.live(f"simulated users of the data, repeat {repeat}",
                             [Run(scenario, *WAYS[way]) for way in ways for scenario in scenarios]))
        spans = {way: mean_over_users([next(runs) for _ in scenarios]) for way in ways}
        knowing = numpy.mean([expected_questions(scenario, float(repeat), SESSIONS // 2) for scenario in scenarios])
        rows.append([repeat, len(scenarios), *(f"{middle:.2f} ± {half:.2f}" for middle, half in spans.values()),
                     f"{knowing:.2f}"])
        measured = spans["adaptive"][0]
        report.goal(f"simulated {repeat}", f"simulated users, repeat {float(repeat):g}, all families", measured,
                    f"{measured:.2f} (who knew their wants: {knowing:.2f})")
    report.section("Simulated users over the author's scenes", DATA_USERS_TEXT,
                   table(["repeat", "users", *(f"`{way}`" for way in ways), "who knew their wants"], rows))


def simulated_kinds(lab, report):
    users = 3 if lab.quick else 20
    ways = ("adaptive", "adaptive, aof", "oain", "count")
    scenarios = {kind: lab.simulate(kind, users, SESSIONS, FIRST_SEED) for kind in KINDS}
    runs = iter(lab.live("simulated users of all habits",
                         [Run(scenario, *WAYS[way]) for scenario in scenarios.values() for way in ways]))
    rows, spans = [], {way: [] for way in ways}
    for kind in KINDS:
        cells = []
        for way in ways:
            lived = next(runs)
            spans[way].append(mean_over_users([lived]))
            cells.append(f"{spans[way][-1][0]:.2f} ± {spans[way][-1][1]:.2f}")
            if way == "adaptive":
                late = mean(of_sessions(lived, SESSIONS - 49, SESSIONS))
        rows.append([f"`{kind}`", *cells, f"{late:.2f}"])
    figure, (axis,) = plots.panels(1, width=7, height=4.4)
    for way in ways:
        colour, marker = plots.STYLES[way]
        means, halves = zip(*spans[way])
        axis.errorbar(means, range(len(KINDS)), xerr=halves, fmt=marker, color=colour, label=way, capsize=2)
    axis.set(yticks=range(len(KINDS)), yticklabels=KINDS, xlabel="questions, mean over users", xlim=(0, None))
    axis.invert_yaxis()
    plots.legend_below(figure, axis, 4)
    report.section(
        "Simulated users of all habits",
        KINDS_TEXT.format(users=users, sessions=SESSIONS, seed=FIRST_SEED),
        table(["mean questions", *(f"`{way}`" for way in ways), "late"], rows),
        plots.save(figure, report, "simulated-kinds", "Mean questions by kind of simulated user"))


def changing_wants(lab, report):
    """How soon a policy follows a change of wants."""
    users = 5 if lab.quick else 100
    figure, axes = plots.panels(3, sharey=True)
    for axis, repeat in zip(axes, (0.0, 0.3, 0.6)):
        scenario = lab.simulate("sparse", users, SESSIONS, FIRST_SEED + 1, repeat)
        lived = live_ways(lab, f"changing wants, repeat {repeat}", scenario, ("adaptive", "oain"))
        for way, runs in lived.items():
            plots.line(axis, *binned(runs[0], 4), name=way, marker=False)
        axis.axvline(SESSIONS / 2 + 0.5, color=plots.BLACK, linewidth=0.8, linestyle=":")
        axis.set(title=f"repeat probability {repeat:g}", xlabel="session")
    plots.count_scale(axes[0])
    axes[0].set_ylabel("questions, mean of 4 sessions")
    plots.legend_below(figure, axes[0], 2)
    report.section("After a change of wants",
                   f"{users} users of kind `sparse` (seed {FIRST_SEED + 1}); their wants change at the dotted line.",
                   plots.save(figure, report, "changing-wants", "Questions before and after a change of wants"))


def noise_sources(lab, sessions, data):
    """What is lived under noise: name, scenarios, number of seeds."""
    if data:
        published = lab.write("published", sessions.as_published("objects") + sessions.as_published("position"))
        simulated = [path for paths in local_simulated(data).values() for path in paths]
        yield "published sessions", [published], 1 if lab.quick else 8
        yield "simulated users of the data", simulated, 1 if lab.quick else 3
    users = 1 if lab.quick else 6 if data else 12
    made = [lab.simulate(kind, users, SESSIONS, FIRST_SEED + 2) for kind in KINDS]
    yield "simulated users of all habits", made, 1


def wrong_answers(lab, report, sessions, data):
    rows, totals = [], {}
    for source, scenarios, seeds in noise_sources(lab, sessions, data):
        for flip in FLIPS:
            for way in NOISE_WAYS:
                runs = lab.live(f"{100 * flip:g} % wrong answers, {way}, {source}", [
                    Run(scenario, *WAYS[way], flip=flip, seed=seed)
                    for scenario in scenarios for seed in range(1, seeds + 1)])
                totals.setdefault((way, flip), []).extend(runs)
                rows.append(noise_row(source, way, flip, Errors(runs)))
    errors = {key: Errors(runs) for key, runs in totals.items()}
    rows += [noise_row("**all**", way, flip, errors[way, flip]) for flip in FLIPS for way in NOISE_WAYS]
    for flip in FLIPS:
        told = errors["adaptive", flip]
        low, high = told.wrong_interval()
        report.goal(f"wrong {flip}", f"wrong tasks at {100 * flip:g} % flipped answers, rate not told",
                    told.wrong_rate(), f"{100 * told.wrong_rate():.2f} % [{100 * low:.2f}, {100 * high:.2f}]", unit=100)
    report.section("Wrong answers", NOISE_TEXT,
                   plot_noise(report, errors),
                   table(["sessions of", "policy", "flipped", "sessions", "mean questions", "wrong", "95 %",
                          "unanswered"], rows))


def noise_row(source, way, flip, errors):
    low, high = errors.wrong_interval()
    return [source, f"`{way}`", f"{100 * flip:g} %", errors.sessions, f"{errors.questions:.2f}",
            f"{100 * errors.wrong_rate():.2f} %", f"{100 * low:.2f} - {100 * high:.2f} %",
            f"{100 * errors.unanswered / errors.sessions:.2f} %"]


def plot_noise(report, errors):
    figure, axes = plots.panels(2, width=4.6)
    percent = [100 * flip for flip in FLIPS]
    for way in NOISE_WAYS:
        told = [errors[way, flip] for flip in FLIPS]
        rates = numpy.array([100 * e.wrong_rate() for e in told])
        spans = 100 * numpy.array([e.wrong_interval() for e in told]).T
        colour, marker = plots.STYLES[way]
        axes[0].errorbar(percent, rates, yerr=(rates - spans[0], spans[1] - rates), color=colour, marker=marker,
                         capsize=3, label=way)
        plots.line(axes[1], percent, [e.questions for e in told], name=way)
    for limit, word in ((1, "must"), (0.2, "aim")):
        axes[0].axhline(limit, color=plots.BLACK, linestyle="--", linewidth=0.8)
        axes[0].annotate(word, (percent[0], limit), textcoords="offset points", xytext=(-6, 3), ha="right", fontsize=8)
    axes[0].set(ylim=(0, 100), xlim=(2, 22), ylabel="wrong tasks, %", xlabel="flipped answers, %", xticks=percent)
    axes[0].set_yscale("symlog", linthresh=0.1)
    axes[0].set_yticks((0, 0.1, 1, 10, 100), ("0", "0.1", "1", "10", "100"))
    axes[1].set(ylabel="questions, mean", xlabel="flipped answers, %", xticks=percent, ylim=(0, None))
    plots.legend_below(figure, axes[1], 3)
    return plots.save(figure, report, "wrong-answers", "Wrong tasks and questions against the rate of wrong answers")


def time_per_question(lab, report, sessions, data):
    """One process at a time, so that nothing of ours is in the way."""
    lives = {name: scenarios for name, scenarios, _ in noise_sources(lab, sessions, data)}
    lives["simulated users of all habits"] = [lab.simulate(kind, 1, SESSIONS, FIRST_SEED + 3) for kind in KINDS]
    rows, everything = [], []
    figure, (axis,) = plots.panels(1, width=5.5)
    for way in ("adaptive", "adaptive, aof", "oain"):
        times = []
        for name, scenarios in lives.items():
            for flip in (0.0, 0.1):
                if flip and way == "oain":
                    continue
                lived = lab.live(f"time per question, {way}, {name}, {100 * flip:g} % wrong answers", [
                    Run(scenario, *WAYS[way], flip=flip, seed=1009) for scenario in scenarios], processes=1)
                told = [o["compute_us"] / o["questions"] for run in lived for o in run if o["questions"]]
                rows.append([name, f"`{way}`", f"{100 * flip:g} %", len(told), f"{numpy.median(told):.0f}",
                             f"{numpy.percentile(told, 95):.0f}", f"{numpy.max(told):.0f}"])
                times += told
        if way == "adaptive":
            everything = times
        shares = numpy.arange(0, 100.1, 0.5)
        axis.plot(numpy.percentile(times, shares), shares, color=plots.STYLES[way][0], label=way)
    median, p95 = numpy.percentile(everything, (50, 95))
    report.goal("time", "time per question, µs: p95 over sessions", p95, f"{p95:.0f} (p50 {median:.0f})")
    axis.set(xscale="log", xlabel="µs a question", ylabel="sessions, %", xlim=(1, 300))
    axis.set_xticks((1, 3, 10, 30, 100, 300), ("1", "3", "10", "30", "100", "300"))
    axis.legend()
    report.section("Time per question", TIME_TEXT,
                   table(["sessions of", "policy", "flipped", "sessions", "p50 µs", "p95 µs", "most µs"], rows),
                   plots.save(figure, report, "time", "Distribution of the time per question"))
