"""What is lived: the author's published sessions in the orders of his experiments, and simulated users."""

import json
import random
from itertools import groupby

GROUPS = (1, 2)
KINDS = ("sparse", "routine", "timetable", "object-first", "action-first", "sequence", "drift", "sudden",
         "favourite-instance", "household", "new-every-time")
FIRST_SEED = 1001  # simulated users of the experiments; those below are for developing on


def read(path):
    with open(path) as file:
        return [json.loads(line) for line in file]


class PublishedSessions:
    """`objects`: objects and their positions change from session to session; `position`: positions only."""

    def __init__(self, data):
        self._lines = {(group, kind): read(data / "intention" / f"thesis_group{group}_{kind}.jsonl")
                       for group in GROUPS for kind in ("objects", "position")}

    def as_published(self, kind):
        """A fresh user for each intention, 20 sessions each."""
        return [line for group in GROUPS for line in self._lines[group, kind]]

    def constant(self):
        """The first scene of each user, 20 times."""
        lines = []
        for kind in ("objects", "position"):
            for _, sessions in self._by_user(self.as_published(kind)):
                first = {key: value for key, value in sessions[0].items() if key != "published"}
                lines += [first] * 20
        return lines

    def continual(self):
        """One user per group and file lives its intentions one after another, 20 sessions each."""
        return [{**line, "user": f"continual-{group}-{kind}"}
                for (group, kind), lines in self._lines.items() for line in lines]

    def in_blocks(self, seed, groups=None):
        """Likewise, the intentions in an order of chance."""
        return self._lives("blocks", seed, groups, self._shuffled_blocks)

    def at_random(self, seed, groups=None):
        """Likewise, the sessions of all intentions in an order of chance."""
        return self._lives("random", seed, groups, lambda lines, chance: chance.sample(lines, len(lines)))

    def _lives(self, name, seed, groups, order):
        """A user for each of `groups` (tuples of group numbers that one user lives) and file."""
        lived = []
        for together in groups or [(group,) for group in GROUPS]:
            for kind in ("objects", "position"):
                lines = [line for group in together for line in self._lines[group, kind]]
                user = f"{name}-{seed}-{together}-{kind}"
                lived += [{**line, "user": user} for line in order(lines, random.Random(seed))]
        return lived

    def _shuffled_blocks(self, lines, chance):
        blocks = [sessions for _, sessions in self._by_user(lines)]
        chance.shuffle(blocks)
        return [line for block in blocks for line in block]

    @staticmethod
    def _by_user(lines):
        return [(user, list(sessions)) for user, sessions in groupby(lines, key=lambda line: line["user"])]


def local_simulated(data):
    """The simulated users that lie with the data, by repeat probability."""
    found = {}
    for path in sorted((data / "intention").glob("simulated_*_repeat*.jsonl")):
        found.setdefault(path.stem.split("repeat")[1], []).append(path)
    return found
