"""What a model would need that knew a simulated user's true preferences: fitted to the very sessions it is scored on.

The user wants, with the repeat probability, the last pair again where it is on the table, else a pair drawn from fixed
weights among what is on the table. The weights are fitted by expectation-maximisation (whether a want that equals the
last was repeated or drawn is hidden; of the drawn ones the weights are the Bradley-Terry-Luce model's, whose
maximum-likelihood iteration is D. R. Hunter's, Annals of Statistics 32, 2004). The cost of a session is the expected
number of questions at the entropy H of its true distribution, H + 0.45 + 0.55 exp(-2.4 H) (docs/intention.md).
"""

import math

from scenarios import read

ROUNDS = 200


def expected_questions(path, repeat, change_at):
    """Mean over the sessions of a scenario of one user, whose preferences change once."""
    sessions = read(path)
    costs = _fit(sessions[:change_at], repeat) + _fit(sessions[change_at:], repeat)
    return sum(costs) / len(costs)


def _fit(sessions, repeat):
    seen = [({thing["category"] for thing in session["scene"]},
             (session["want"]["category"], session["want"]["action"])) for session in sessions]
    weights = {want: 1.0 for _, want in seen}
    for _ in range(ROUNDS):
        drawn, offered, costs = dict.fromkeys(weights, 0.0), dict.fromkeys(weights, 0.0), []
        last = None
        for categories, want in seen:
            there = {pair: weight for pair, weight in weights.items() if pair[0] in categories}
            total = sum(there.values())
            again = repeat if last in there else 0.0
            chances = {pair: (1 - again) * weight / total + again * (pair == last) for pair, weight in there.items()}
            fresh = (1 - again) * weights[want] / total / chances[want]
            drawn[want] += fresh
            for pair in there:
                offered[pair] += fresh / total
            costs.append(_cost(chances.values()))
            last = want
        weights = {pair: max(drawn[pair] / offered[pair], 1e-9) for pair in weights}
    return costs


def _cost(chances):
    entropy = -sum(chance * math.log2(chance) for chance in chances if chance > 0)
    return entropy + 0.45 + 0.55 * math.exp(-2.4 * entropy)
