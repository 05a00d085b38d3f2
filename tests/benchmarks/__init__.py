"""Figures of the program. The planner is loaded first: it sets the threads of linear algebra before numpy is there."""

import planner as planner
