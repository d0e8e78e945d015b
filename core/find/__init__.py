"""Questions asked backwards: with which inputs does an answer have a property?"""
