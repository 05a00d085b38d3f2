import numpy as np

from planner.policy.lookahead import fisher_information, optimal_headings
from planner.study.courses import draw_courses, moving_course, two_platform_course


def test_two_platforms_learn_more_than_one_flown_twice():
    course = two_platform_course()
    best = np.linalg.det(fisher_information(course, optimal_headings(course)))
    together = np.repeat(optimal_headings(course)[:1], 2, axis=0)
    assert best > np.linalg.det(fisher_information(course, together))


def test_the_moving_target_moves():
    assert moving_course().velocity[1] > 0


def test_four_panels_with_a_course_for_every_ratio():
    stationary, myopic, moving, two = draw_courses().axes
    assert len(stationary.lines) == len(myopic.lines) == 9
    assert len(moving.lines) == len(two.lines) == 3
