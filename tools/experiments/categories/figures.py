"""What was said of views beside the truth, the figures it is judged by, and their intervals."""

from dataclasses import dataclass, fields

import numpy

UNKNOWN = "Unknown"
FIGURES = ("accuracy", "macro recall", "top 3", "surest 70 %", "asks about", "calibration error")
BINS = 10
RESAMPLES, SEED = 1000, 9001


@dataclass(frozen=True)
class Judged:
    """Arrays, an entry a view."""

    file: numpy.ndarray
    category: numpy.ndarray
    product: numpy.ndarray  # category and instance: views of one thing belong together
    predicted: numpy.ndarray
    top: numpy.ndarray  # probability of what was said
    in_top_3: numpy.ndarray
    confidence: numpy.ndarray
    asked: numpy.ndarray
    ms: numpy.ndarray

    def __len__(self):
        return len(self.file)

    @property
    def right(self):
        return self.category == self.predicted

    def only(self, which):
        """A mask or indices."""
        return Judged(*(getattr(self, field.name)[which] for field in fields(self)))

    def known(self):
        return self.only(self.category != UNKNOWN)

    def strange(self):
        return self.only(self.category == UNKNOWN)


def together(judged):
    return Judged(*(numpy.concatenate([getattr(one, field.name) for one in judged]) for field in fields(Judged)))


def judged_from(lines, rows):
    """Of the lines of `--test --jsonl`. A view without an answer is Unknown and asked about."""
    columns = []
    for line in lines:
        p, row = line["probabilities"], rows[line["file"]]
        own = p.get(line["category"], 0)
        columns.append((line["file"], line["category"], f"{line['category']}/{row.get('product') or row['instance']}",
                        line["predicted"], max(p.values(), default=0), sum(q > own for q in p.values()) < 3 and own > 0,
                        line["confidence"], line["ask_user"], line["time_ms"]))
    return Judged(*map(numpy.array, zip(*columns)))


def reliability(judged, bins=BINS):
    """Of bins of equal counts, the least probable first: views, mean claim, share that came true."""
    order = numpy.argsort(judged.top, kind="stable")
    cuts = numpy.arange(1, bins) * len(order) // bins  # as beckon-train cuts them
    parts = [part for part in numpy.split(order, cuts) if len(part)]
    return numpy.array([(len(part), judged.top[part].mean(), judged.right[part].mean()) for part in parts])


def calibration_error(judged):
    count, claim, truth = reliability(judged).T
    return float(numpy.sum(count * numpy.abs(claim - truth)) / len(judged))


def macro_recall(judged):
    _, category = numpy.unique(judged.category, return_inverse=True)
    return float(numpy.mean(numpy.bincount(category, judged.right) / numpy.bincount(category)))


def surest(judged, share):
    order = numpy.argsort(-judged.confidence, kind="stable")[:int(share * len(judged) + 0.5)]
    return float(judged.right[order].mean())


def figures(judged):
    """FIGURES of the views of known categories."""
    known = judged.known()
    return numpy.array([known.right.mean(), macro_recall(known), known.in_top_3.mean(), surest(known, 0.7),
                        known.asked.mean(), calibration_error(known)])


def resamples(judged, count=RESAMPLES):
    """Indices of views of products that were drawn with replacement."""
    rng = numpy.random.default_rng(SEED)
    _, product = numpy.unique(judged.product, return_inverse=True)
    members = numpy.split(numpy.argsort(product, kind="stable"), numpy.cumsum(numpy.bincount(product))[:-1])
    for _ in range(count):
        yield numpy.concatenate([members[i] for i in rng.integers(len(members), size=len(members))])


def intervals(judged, count=RESAMPLES):
    """95 % of each of FIGURES, low and high, by bootstrap over products. Calibration errors of resamples are larger
    than the views' own, as repeated views err together: they are moved by their mean excess."""
    known = judged.known()
    drawn = numpy.array([figures(known.only(which)) for which in resamples(known, count)])
    limits = numpy.percentile(drawn, (2.5, 97.5), axis=0)
    limits[:, -1] -= drawn[:, -1].mean() - figures(known)[-1]
    return limits.clip(0, 1)


def gain(one, other, count=RESAMPLES):
    """By how much more often `one` is right than `other` about the same views, and 95 % of that."""
    one, other = one.known(), other.known()
    assert (one.file == other.file).all()
    more = one.right.astype(float) - other.right
    drawn = [more[which].mean() for which in resamples(one, count)]
    return (more.mean(), *numpy.percentile(drawn, (2.5, 97.5)))


def mean_interval(judged, values, count=RESAMPLES):
    """95 % of the mean of `values`, one a view, by bootstrap over products."""
    return numpy.percentile([values[which].mean() for which in resamples(judged, count)], (2.5, 97.5))
