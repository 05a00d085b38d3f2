import planner as planner  # it sets the threads of linear algebra, before numpy is loaded
