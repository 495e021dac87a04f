"""The schemas in docs/ and the readers agree: on every example, and on every example with one thing changed.

What a schema cannot say (names that nobody has, outlines that cross themselves) is left to other tests.
"""

import copy
import glob
import json
import re
import subprocess
import sys
import warnings
from pathlib import Path

warnings.simplefilter("ignore", DeprecationWarning)
from jsonschema import Draft202012Validator, RefResolver  # noqa: E402

source, verdicts = sys.argv[1:]

schemas = {name: json.load(open(f"{source}/docs/{name}.schema.json")) for name in ("section", "scene")}
store = {f"{name}.schema.json": schema for name, schema in schemas.items()}


def validator(kind):
    Draft202012Validator.check_schema(schemas[kind])
    return Draft202012Validator(schemas[kind], resolver=RefResolver.from_schema(schemas[kind], store=store))


def places(value, place=()):
    yield place
    items = value.items() if isinstance(value, dict) else enumerate(value) if isinstance(value, list) else ()
    for key, inner in items:
        yield from places(inner, place + (key,))


def at(value, place):
    for key in place:
        value = value[key]
    return value


OTHERS = [None, True, "x", -1, 0, 0.5, [], {}, [1, 2], [[0, 0], [1, 1]]]


def mutations(example):
    """The example with one value replaced, one key taken away, one added, one element doubled."""
    for place in places(example):
        if not place:
            continue
        for other in OTHERS:
            changed = copy.deepcopy(example)
            at(changed, place[:-1])[place[-1]] = other
            yield place, other, changed
        changed = copy.deepcopy(example)
        del at(changed, place[:-1])[place[-1]]
        yield place, "(gone)", changed
    for place in places(example):
        if isinstance(at(example, place), dict):
            changed = copy.deepcopy(example)
            at(changed, place)["colour"] = 1
            yield place, "(colour)", changed


def differs_by_right(kind, place, other, changed):
    """What only one of the two can know."""
    last = place[-1] if place else None
    inside = [key for key in place if isinstance(key, str)]
    if isinstance(other, str) and other == "x" or other == "(gone)" or other == "(colour)":
        # A name that must be a material's or a drawing's.
        if last in ("material", "outline", "profile") or "materials" in place[-2:]:
            return True
    if "materials" in inside and (len(inside) == 1 or inside[-2] == "materials" or other in ("(gone)", "(colour)")):
        return True  # bodies name them
    if isinstance(other, str) and last == "name":
        return True
    if last == "axis" or (inside and inside[-1] in ("axis", "along")):
        return True  # two equal points
    if last in ("outer", "outline", "holes") or (inside and inside[-1] in ("outer", "outline", "holes")):
        return True  # a ring of two points has a form, and no area
    return False


checked = disagreements = 0
for kind in ("section", "scene"):
    valid = validator(kind)
    examples = glob.glob(f"{source}/tests/files/schema/*.{kind}.json") + glob.glob(f"{source}/scenes/*.{kind}.json")
    assert examples or kind == "section", f"no {kind} examples"
    for file in examples:
        example = json.load(open(file))
        errors = [f"{error.json_path}: {error.message[:200]}" for error in valid.iter_errors(example)]
        assert not errors, f"{file}: {errors}"
    example = json.load(open(f"{source}/tests/files/schema/everything.{kind}.json"))
    cases = [((), "(as it is)", example), *mutations(example)]
    text = "".join(json.dumps(changed) + "\n" for _, _, changed in cases)
    said = subprocess.run([verdicts, kind], input=text, capture_output=True, text=True, check=True).stdout.splitlines()
    assert len(said) == len(cases) and said[0] == "accepted", said[0]
    for (place, other, changed), verdict in zip(cases, said):
        if differs_by_right(kind, place, other, changed):
            continue
        checked += 1
        if valid.is_valid(changed) != (verdict == "accepted"):
            disagreements += 1
            print(f"{kind} {place} = {other!r}: schema says {valid.is_valid(changed)}, reader: {verdict}")

# The tables of fields, from which readers and writers work: each field stands in the schema with its default, and its
# unit at the head of what is said of it; and in a table of the page. (That the ranges agree, the cases above show.)
page = Path(f"{source}/docs/files/scene.md").read_text()
scene = schemas["scene"]
definitions = scene["$defs"]
material = definitions["material"]["oneOf"][1]
elastic = next(way for way in definitions["elastic"]["oneOf"] if way.get("type") == "object")
objects = {"strength": material, "substance": material, "elastic": elastic, "scene": scene,
           "overrides": definitions["override_keys"],
           **{name: definitions[name] for name in ("body", "joint", "drive", "support", "load", "wheel")},
           "springs": definitions["support"]["properties"]["stiffness"]}
tables = json.loads(subprocess.run([verdicts, "fields"], capture_output=True, text=True, check=True).stdout)
assert tables.keys() == objects.keys(), tables.keys()
for name, table in tables.items():
    for field in table:
        checked += 1
        said = objects[name]["properties"].get(field["key"])
        if said is None:
            disagreements += 1
            print(f"{name}.{field['key']} is not in the schema")
            continue
        wrong = []
        if field["unit"] and field["unit"] not in re.split("[,;:] ?|[.]", said.get("description", ""))[:2]:
            wrong.append(f"its description does not begin with its unit, {field['unit']}")
        if "default" in said and field["default"] not in (said["default"], "no default"):
            wrong.append(f"default {said['default']} is {field['default']}")
        if field["required"] and field["key"] not in objects[name].get("required", []):
            wrong.append("it is required")
        key = re.compile(rf"[`\"]{field['key']}[`\"]")
        if not any(line.startswith("|") and key.search(line) and field["unit"] in line for line in page.splitlines()):
            wrong.append(f"docs/files/scene.md has no row with the key and its unit, {field['unit']}")
        disagreements += len(wrong)
        for what in wrong:
            print(f"{name}.{field['key']}: {what}")

print(f"{checked} cases, {disagreements} disagreements")
sys.exit(1 if disagreements or checked < 1000 else 0)
