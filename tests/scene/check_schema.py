"""Compares scenes/schema.json with the tables of keys that the JSON reader works by, and checks
scenes against the schema.

Usage: check_schema.py SOURCE_DIR DUMP_TABLES"""

import json
import pathlib
import subprocess
import sys

try:
    import jsonschema
except ImportError:
    print("skipped: Python has no jsonschema (Debian: apt install python3-jsonschema)")
    sys.exit(77)
if not hasattr(jsonschema, "Draft202012Validator"):
    print("skipped: this jsonschema is older than 4.0 and has no draft 2020-12")
    sys.exit(77)

BOUNDS = ("minimum", "maximum", "exclusiveMinimum", "exclusiveMaximum")
problems = []


def resolve(schema, part):
    """`part` with what it refers to filled in."""
    while "$ref" in part:
        found = schema
        for step in part["$ref"].removeprefix("#/").split("/"):
            found = found[step]
        part = {**found, **{k: v for k, v in part.items() if k != "$ref"}}
    return part


def objects(part):
    """Every schema of an object with properties."""
    if isinstance(part, dict):
        if "properties" in part:
            yield part
        for child in part.values():
            yield from objects(child)
    elif isinstance(part, list):
        for child in part:
            yield from objects(child)


def check_key(schema, where, key, part):
    part = resolve(schema, part)
    defs = schema["$defs"]
    kind = key["type"]
    if kind in ("number", "integer", "boolean", "string") and part.get("type") != kind:
        problems.append(f"{where}: the reader wants {kind}, the schema {part.get('type')}")
    if kind in ("point", "direction", "color"):
        shape = {k: v for k, v in part.items() if k != "description"}
        if shape != {k: v for k, v in defs[kind].items() if k != "description"}:
            problems.append(f"{where}: the schema does not refer to {kind}")
    if kind == "choice" and part.get("enum") != key["choices"]:
        problems.append(f"{where}: {key['choices']} in the reader, {part.get('enum')} in the schema")
    for bound in BOUNDS:
        if kind in ("number", "integer") and part.get(bound) != key.get(bound):
            problems.append(f"{where}: {bound} is {key.get(bound)} in the reader, "
                            f"{part.get(bound)} in the schema")


def compare(schema, tables):
    known = {}
    for part in objects(schema):
        title = part.get("title", "(an object without title)")
        if title in known:
            problems.append(f"{title}: twice in the schema")
        known[title] = part
    for title in known.keys() - tables.keys():
        problems.append(f"{title}: in the schema, but the reader has no such table")
    for title, table in tables.items():
        if title not in known:
            problems.append(f"{title}: not in the schema")
            continue
        part = known[title]
        properties = part["properties"]
        if part.get("additionalProperties") is not False:
            problems.append(f"{title}: the schema allows unknown keys")
        for name in properties.keys() ^ table.keys():
            side = "schema" if name in properties else "reader"
            problems.append(f"{title}.{name}: only in the {side}")
        required = {name for name, key in table.items() if key["required"]}
        for name in required ^ set(part.get("required", [])):
            problems.append(f"{title}.{name}: required in only one of reader and schema")
        for name in properties.keys() & table.keys():
            check_key(schema, f"{title}.{name}", table[name], properties[name])


def read_json(path):
    return json.loads(path.read_text(encoding="utf-8-sig"))


def main():
    source, dump = pathlib.Path(sys.argv[1]), sys.argv[2]
    schema = read_json(source / "scenes" / "schema.json")
    jsonschema.Draft202012Validator.check_schema(schema)
    validator = jsonschema.Draft202012Validator(schema)
    tables = json.loads(subprocess.run([dump], check=True, capture_output=True, text=True).stdout)
    compare(schema, tables)

    scenes = [p for p in sorted((source / "scenes").glob("*.json")) if p.name != "schema.json"]
    good = sorted((source / "tests" / "scene" / "data" / "good").glob("*.json"))
    bad = sorted((source / "tests" / "scene" / "data" / "bad").glob("*.json"))
    if not good or not bad:
        problems.append("no files in tests/scene/data")
    files = scenes + good + bad
    result = subprocess.run([dump, *map(str, files)], check=True, capture_output=True, text=True)
    for path, verdict in zip(files, result.stdout.splitlines(), strict=True):
        errors = list(validator.iter_errors(read_json(path)))
        if (verdict == "ok") == (path in bad):
            problems.append(f"{path}: the reader says: {verdict}")
        if (not errors) == (path in bad):
            best = jsonschema.exceptions.best_match(errors)
            problems.append(f"{path}: the schema says: "
                            f"{best.json_path + ': ' + best.message if best else 'ok'}")
    for problem in problems:
        print(problem)
    print(f"{len(tables)} tables, {len(scenes)} scenes, {len(good)} good and {len(bad)} bad files, "
          f"{len(problems)} problems")
    return 1 if problems else 0


sys.exit(main())
