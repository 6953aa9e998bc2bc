"""The look of the plots: one palette that colour-blind people can tell apart, published figures dashed."""

import matplotlib

matplotlib.use("svg")
import matplotlib.pyplot as pyplot  # noqa: E402  (after the back end is chosen)

# M. Okabe, K. Ito, "Color universal design", 2008.
BLACK, ORANGE, SKY, GREEN, YELLOW, BLUE, VERMILION, PURPLE = (
    "#000000", "#E69F00", "#56B4E9", "#009E73", "#F0E442", "#0072B2", "#D55E00", "#CC79A7")
STYLES = {  # name: (colour, marker)
    "adaptive": (BLUE, "o"), "adaptive, aof": (SKY, "s"), "oain": (VERMILION, "^"), "count": (ORANGE, "D"),
    "random-scene": (PURPLE, "v"), "random": (BLACK, "x"),
    "multiscale": (ORANGE, "D"), "multiscale, smoothed": (GREEN, "s"), "classic": (VERMILION, "^"),
    "hierarchical": (PURPLE, "v"), "adaptive, neighbourhood known": (SKY, "s"),
    "fast": (BLUE, "o"), "reference": (VERMILION, "^"),
}
PROGRAMS = {  # published ones, dashed
    "Duncan 2013": (ORANGE, "D"), "Duncan 2013, not smoothed": (YELLOW, "d"), "superquadric-lib": (BLACK, "x"),
    "EMS 2022": ("#777777", "+"),
}

matplotlib.rcParams.update({
    "svg.fonttype": "none", "svg.hashsalt": "beckon", "font.family": "sans-serif", "font.size": 10,
    "axes.spines.top": False, "axes.spines.right": False, "axes.grid": True, "grid.color": "#dddddd",
    "grid.linewidth": 0.6, "axes.axisbelow": True, "legend.frameon": False, "figure.constrained_layout.use": True,
    "lines.linewidth": 1.6, "lines.markersize": 4, "axes.titlesize": 11,
})


def shades(count):
    """For an ordered series, dark to light; told apart without colour too."""
    return [pyplot.cm.viridis(0.9 * step / (count - 1)) for step in range(count)]


def panels(columns, width=4.2, height=3.4, rows=1, **how):
    figure, axes = pyplot.subplots(rows, columns, figsize=(width * columns, height * rows), squeeze=False, **how)
    return figure, axes.flatten()


def line(axis, x, mean, half=None, name=None, label=None, dashed=False, colour=None, marker=True):
    style_colour, style_marker = STYLES.get(name, (colour or BLACK, ""))
    axis.plot(x, mean, color=colour or style_colour, marker=style_marker if marker and not dashed else "",
              linestyle="--" if dashed else "-", label=label or name,
              zorder=3 if name == "adaptive" else 2)
    if half is not None:
        axis.fill_between(x, mean - half, mean + half, color=colour or style_colour, alpha=0.18, linewidth=0)


def count_scale(axis, ticks=(1, 2, 3, 5, 10, 20)):
    """A logarithmic axis of questions with plain numbers."""
    axis.set_yscale("log")
    axis.set_yticks(ticks)
    axis.set_yticklabels([str(tick) for tick in ticks])
    axis.yaxis.set_minor_locator(matplotlib.ticker.NullLocator())


def plain_numbers(axis, ticks):
    """Plain numbers along a logarithmic axis."""
    axis.set_ticks(ticks, [f"{tick:g}" for tick in ticks])
    axis.set_minor_locator(matplotlib.ticker.NullLocator())


def boxes(axis, groups, at, width, colour, label):
    """Medians, quartiles, and from the 5th to the 95th percentile."""
    drawn = axis.boxplot(groups, positions=at, widths=width, whis=(5, 95), showfliers=False, patch_artist=True,
                         medianprops={"color": BLACK}, boxprops={"facecolor": colour, "linewidth": 0.5},
                         whiskerprops={"color": colour}, capprops={"color": colour}, manage_ticks=False)
    drawn["boxes"][0].set_label(label)


def legend_below(figure, axis, columns):
    handles, labels = axis.get_legend_handles_labels()
    figure.legend(handles, labels, loc="upper center", bbox_to_anchor=(0.5, 0.0), ncol=columns)


def save(figure, report, name, alt):
    """Writes the plot; the Markdown that shows it."""
    # The tight box keeps a legend that stands outside the axes.
    figure.savefig(report.folder / f"{name}.svg", bbox_inches="tight", metadata={"Date": None})
    pyplot.close(figure)
    return report.picture(name, alt)
