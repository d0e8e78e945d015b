"""Questions that can be sent as they are: the folder of each is the path of its endpoint below /v1."""
