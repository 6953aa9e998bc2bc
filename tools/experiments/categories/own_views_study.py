"""Learning from a lab's own views: the model, and the model improved by a few views (`beckon-train --data --base`)."""

from concurrent.futures import ThreadPoolExecutor, as_completed

import numpy

from categories.figures import FIGURES, figures, together
from categories.lab import Test
from lab import progress
from report import table

SEED, SPLITS = 9201, {"objects": 8, "meshes any": 4}
TITLES = {"objects": "real views", "meshes any": "rendered meshes, any depth camera"}
TEXT = """\
In each random split (seed {seed}) half of the products of each category are one's own, and half of their views are learnt from
(`beckon-train --data DIR --base MODEL`); judged are the other views of these products, and all views of the products
that are not one's own. Known categories; figures over the views of all splits together, the standard deviation of the
accuracy between splits behind it. *Turned right*, *wrong*: by the own views, of all judged."""


def own_views(lab, report, sets, judged):
    parts = [TEXT.format(seed=SEED)]
    for name, count in SPLITS.items():
        if name not in sets.by_name:
            continue
        views, before = sets.by_name[name], judged[name, "all"]
        splits = [split(before, numpy.random.default_rng([SEED, i])) for i in range(1 if lab.quick else count)]
        after = improved(lab, name, views, before, splits)
        learnt = sorted(len(own) for own, _, _ in splits)
        parts += [f"**{TITLES[name].capitalize()}**, {len(splits)} splits, {words(learnt)} learnt:",
                  table(["", "views judged", *FIGURES, "turned right", "wrong"], rows(before, after, splits))]
    if len(parts) > 1:
        report.section("Learning from a lab's own views", *parts)


def words(learnt):
    return f"{learnt[0]} views" if learnt[0] == learnt[-1] else f"{learnt[0]} to {learnt[-1]} views"


def split(judged, rng):
    """Indices of the views to learn from, of the other views of those products, and of other products. Of a category's
    products half are one's own, an odd one by the toss of a coin."""
    own, others, strangers = [], [], []
    for category in numpy.unique(judged.category):
        products = rng.permutation(numpy.unique(judged.product[judged.category == category]))
        half = (len(products) + rng.integers(2)) // 2
        for product in products[:half]:
            views = rng.permutation(numpy.flatnonzero(judged.product == product))
            learnt = (len(views) + 1) // 2
            own += list(views[:learnt])
            others += list(views[learnt:])
        strangers += list(numpy.flatnonzero(numpy.isin(judged.product, products[half:])))
    return sorted(own), sorted(others), sorted(strangers)


def improved(lab, name, views, before, splits):
    """What the model says of all views, once it has learnt, by split."""
    def learn(i):
        return lab.improve(f"{name.replace(' ', '-')}-{i}", views, [str(file) for file in before.file[splits[i][0]]])

    models = {}
    with ThreadPoolExecutor(lab.processes) as pool:
        pending = {pool.submit(learn, i): i for i in range(len(splits))}
        for done, future in enumerate(as_completed(pending), 1):
            models[pending[future]] = future.result()
            progress(f"learning from own views, {TITLES[name]}", done, len(splits), "models")
    return lab.judge(f"judging what was learnt, {TITLES[name]}",
                     [Test(views, "all", models[i]) for i in range(len(splits))])


def rows(before, after, splits):
    out = []
    for title, at in (("other views of one's own products", 1), ("other products", 2)):
        kept = [(before.only(parts[at]), one.only(parts[at])) for parts, one in zip(splits, after) if parts[at]]
        if not kept:
            continue
        old, new = (together(list(side)) for side in zip(*kept))
        turned = ["", ""], [f"{(new.right & ~old.right).mean():.3f}", f"{(old.right & ~new.right).mean():.3f}"]
        for label, side, one, more in ((title, 0, old, turned[0]), ("", 1, new, turned[1])):
            spread = numpy.std([pair[side].right.mean() for pair in kept])
            out.append([f"{title}: base" if not side else "base and own views", len(one), *cells(one, spread), *more])
    return out


def cells(judged, spread):
    accuracy, *others = figures(judged)
    return [f"{accuracy:.3f} ± {spread:.2f}", *(f"{other:.3f}" for other in others)]
