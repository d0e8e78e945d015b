"""Where questions are answered: handler, cost model, admission, worker pool, response cache."""
