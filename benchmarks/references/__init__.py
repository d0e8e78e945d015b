"""Published problems of mechanics, each answered in pairs of doubles: figures that others can take as references."""
