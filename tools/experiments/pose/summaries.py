"""From scores of clouds to figures: medians and worst 5 %, as the scorer tells them."""

import numpy

SHOWN = {  # key: (heading, digits)
    "time_ms": ("time, ms", 2), "position_mm": ("position, mm", 2), "size_percent": ("size, %", 2),
    "orientation_deg": ("orientation, °", 2), "iou": ("IoU", 3), "radial_mm": ("radial, mm", 2),
}


def values(scores, key):
    return numpy.array([score[key] for score in scores], float)


def worst(key):
    """The percentile that tells of the worst 5 %."""
    return 5 if key == "iou" else 95


def pair(numbers, tail=95):
    """Median and percentile; None where there are no numbers."""
    numbers = numpy.asarray(numbers, float)
    numbers = numbers[numpy.isfinite(numbers)]
    return tuple(numpy.percentile(numbers, (50, tail))) if len(numbers) else None


def pair_of(scores, key):
    return pair(values(scores, key), worst(key))


def shown(told, digits=2):
    return "" if told is None else f"{told[0]:.{digits}f} / {told[1]:.{digits}f}"


def cells(scores, keys):
    return [shown(pair_of(scores, key), SHOWN[key][1]) for key in keys]


def headings(keys):
    return [SHOWN[key][0] for key in keys]


def good(scores):
    return f"{int(sum(score['good'] for score in scores))} of {len(scores)}"


def shares(numbers):
    """Sorted numbers and the share of all that are at most each, in %."""
    numbers = numpy.asarray(numbers, float)
    numbers = numpy.sort(numbers[numpy.isfinite(numbers)])
    return numbers, 100 * numpy.arange(1, len(numbers) + 1) / max(len(numbers), 1)
