"""A bar out of a wall, whose root carries 4e6 N m at rest and gives way at 3.8e6, and a tag at its tip that breaks
off at once: between them they do all that a joint can do."""


def breaking_bar(tag="tag"):
    """A scene file; `tag` is what the tag is called."""
    return {
        "gravity": [0, -10],
        "joint": {"elastic": "rigid"},
        "materials": {"steel": {"density": 8000, "E": 200e9, "fy": 400e6}},
        "bodies": [
            {"name": "wall", "type": "static", "outline": [[-1, -1], [0, -1], [0, 2], [-1, 2]]},
            {"name": "bar", "outline": [[0, 0], [10, 0], [10, 1], [0, 1]], "material": "steel",
             "split": {"pieces": 4}},
            {"name": tag, "outline": [[10, 0], [10.5, 0], [10.5, 1], [10, 1]], "material": "steel"}],
        "joints": [
            {"between": ["wall", "bar"], "moment": 3.8e6},
            {"between": ["bar", tag], "moment": 1e3, "max_rotation": 0.02}]}
