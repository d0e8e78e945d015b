"""Numbers of a question found from measured data: least squares with the errors that the data and the motion leave."""
