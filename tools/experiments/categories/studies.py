"""All studies of the categories, those for which there is what they need."""

from categories.certainty_studies import certainty, strange_things
from categories.condition_studies import conditions
from categories.cue_studies import cue_against_cue
from categories.depth_study import depth_noise
from categories.figures import RESAMPLES
from categories.glance_study import confusions, glance, goals
from categories.own_views_study import own_views
from categories.pictures import surest_errors
from categories.sets import WAYS, Sets


def run_all(lab, capture, report, data):
    """Whether nothing was left out."""
    sets = Sets(lab, capture, report, data)
    judged = sets.judge(lab, "the dissertation's cues and all", list(WAYS.values()))
    resamples = 100 if lab.quick else RESAMPLES
    glance(report, sets, judged, resamples)
    confusions(report, judged)
    goals(report, judged, resamples, cue_against_cue(lab, report, sets))
    certainty(report, judged)
    strange_things(report, judged)
    surest_errors(report, sets, judged)
    conditions(report, sets, judged)
    own_views(lab, report, sets, judged)
    return depth_noise(lab, capture, report, sets, data) and sets.are_whole
