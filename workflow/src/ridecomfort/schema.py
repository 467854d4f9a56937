"""Configuration against its schema: defaults filled in, a mistake named in one line."""

from __future__ import annotations

import copy
import math
from collections.abc import Iterable, Iterator, Mapping
from functools import cache
from pathlib import Path

import yaml
from jsonschema import Draft202012Validator, ValidationError, validators

from .errors import InputError, hint

SCHEMAS = Path(__file__).parents[2] / "schemas"

_TYPES = {
    "string": "text",
    "integer": "a whole number",
    "number": "a number",
    "boolean": "true or false",
    "array": "a list",
    "object": "a mapping of keys to values",
    "null": "null",
}

SHORT = 60
"""Characters up to which a mapping that stands in the place of a list is told as it is."""

NOT_TEXT = {type(None): "nothing (null, ~)", bool: "yes or no (true, false)"}
"""What YAML makes of words that are no text; of all else a number or a date."""


class _Loader(yaml.SafeLoader):
    """Refuses a key that stands twice, of which YAML takes the last."""

    def construct_mapping(self, node, deep=False):
        lines: dict = {}
        for key, _ in node.value:
            if not isinstance(key, yaml.ScalarNode):
                raise yaml.MarkedYAMLError(problem="a key is a list or mapping, expected a name", problem_mark=key.start_mark)
            if key.value in lines:
                raise yaml.MarkedYAMLError(problem=f"key {key.value!r} stands in line {lines[key.value] + 1} already", problem_mark=key.start_mark)
            lines[key.value] = key.start_mark.line
        return super().construct_mapping(node, deep)

    def construct_object(self, node, deep=False):
        try:
            return super().construct_object(node, deep)
        except ValueError as problem:  # of what looks like a date or a number and is none
            raise yaml.MarkedYAMLError(problem=f"{node.value!r}: {problem}", problem_mark=node.start_mark) from None


def read_yaml(path) -> dict:
    """The mapping that a YAML file holds. Raises InputError where it is none."""
    path = Path(path)
    try:
        content = yaml.load(path.read_text(encoding="utf-8"), Loader=_Loader)
    except OSError as problem:
        raise InputError(f"cannot be read ({problem.strerror})", file=path) from None
    except UnicodeDecodeError:
        raise InputError("is not a text file", file=path) from None
    except yaml.YAMLError as problem:
        mark = getattr(problem, "problem_mark", None)
        place = f"line {mark.line + 1}" if mark else None
        said = getattr(problem, "problem", None)
        raise InputError("is not valid YAML" + (f" ({said})" if said else ""), file=path, place=place) from None
    if not isinstance(content, dict):
        raise InputError("expected a mapping of keys to values", file=path)
    return content


def validate(settings: Mapping, kind: str, file) -> dict:
    """A copy of the settings with every default of the schema ``kind`` filled in, in the order of the schema.

    Raises InputError that names the file, the key, the value and what was expected.
    """
    schema = load(kind)
    errors = sorted(_Validator(schema).iter_errors(settings), key=lambda error: error.json_path)
    if errors:
        error = _inmost(errors[0])
        raise InputError(_explain(error), file=file, place=_place(error.absolute_path))
    for path, value in _leaves(settings):
        if isinstance(value, float) and not math.isfinite(value):
            raise InputError(f"{value!r}, expected a finite number", file=file, place=_place(path))
    return _filled(copy.deepcopy(dict(settings)), schema, schema)


def defaults(kind: str, **required) -> dict:
    """The settings of a file that states nothing but its required keys."""
    return validate(required, kind, kind)


@cache
def load(kind: str) -> Mapping:
    """The schema of ``study``, ``site``, ``vehicle`` or ``standin``."""
    return yaml.safe_load((SCHEMAS / f"{kind}.yaml").read_text(encoding="utf-8"))


def as_written(number: float) -> str:
    """A number to three digits as a configuration takes it."""
    return as_yaml(float(f"{number:.3g}"))


def as_yaml(number: float) -> str:
    """A number with all of its digits as a configuration takes it: YAML 1.1 reads one with an exponent and no point before it as text."""
    said = repr(_plain(float(number)))
    return said if "e" not in said or "." in said else said.replace("e", ".0e")


def _ascending(validator, wanted, instance, schema):
    numbers = [value for value in instance if isinstance(value, (int, float))] if isinstance(instance, list) else []
    if wanted and numbers != sorted(numbers):
        yield ValidationError(f"{instance!r}, expected the lower value first")


_Validator = validators.extend(Draft202012Validator, {"ascending": _ascending})


def _leaves(value, path: tuple = ()) -> Iterator[tuple[tuple, object]]:
    if isinstance(value, Mapping):
        for key, part in value.items():
            yield from _leaves(part, (*path, key))
    elif isinstance(value, list):
        for index, part in enumerate(value):
            yield from _leaves(part, (*path, index))
    else:
        yield path, value


def _place(path: Iterable) -> str | None:
    return ": ".join(f"entry {key + 1}" if isinstance(key, int) else str(key) for key in path) or None


def _inmost(error: ValidationError) -> ValidationError:
    """The error itself, or of one of several forms, of which one would fit but for numbers that are text, the first of these."""
    forms: dict[int, list[ValidationError]] = {}
    for part in error.context if error.validator == "oneOf" else ():
        forms.setdefault(part.schema_path[0], []).append(part)
    return next((parts[0] for parts in forms.values() if all(map(_is_number_as_text, parts))), error)


def _is_number_as_text(error: ValidationError) -> bool:
    if error.validator != "type":
        return False
    wanted = {error.validator_value} if isinstance(error.validator_value, str) else {*error.validator_value}
    return isinstance(error.instance, str) and bool({"number", "integer"} & wanted) and _is_number(error.instance)


def _explain(error: ValidationError) -> str:
    value, expected = error.instance, error.validator_value
    meaning = error.schema.get("description", "") if isinstance(error.schema, Mapping) else ""
    meaning = f" ({meaning.strip().split('. ')[0].rstrip('.')})" if meaning else ""
    match error.validator:
        case "additionalProperties":
            known = list(error.schema.get("properties", {}))
            unknown = next(key for key in value if key not in known)
            return f"unknown key {unknown!r}; {hint(unknown, known, 'known keys:')}"
        case "required":
            missing = next(key for key in expected if key not in value)
            return f"key {missing!r} is missing"
        case "type":
            kinds = [expected] if isinstance(expected, str) else expected
            as_text = f"; YAML reads this as text, write {as_yaml(float(value))}" if _is_number_as_text(error) else ""
            quoted = ""
            if kinds == ["array"] and isinstance(value, dict):
                told = f"{value!r}" if len(f"{value!r}") <= SHORT else f"a mapping of {', '.join(map(str, value))}"
                return f"{told}, expected a list, each entry of which begins with '- '{meaning}"
            if "string" in kinds and not isinstance(value, (str, dict, list)):
                quoted = f"; YAML reads what stands there as {NOT_TEXT.get(type(value), 'a number or a date')}, write it in quotes if it is a name"
            return f"{value!r}, expected {' or '.join(_TYPES[kind] for kind in kinds)}{as_text}{meaning}{quoted}"
        case "minimum":
            return f"{value!r}, expected at least {expected}{meaning}"
        case "maximum":
            return f"{value!r}, expected at most {expected}{meaning}"
        case "exclusiveMinimum":
            return f"{value!r}, expected more than {expected}{meaning}"
        case "enum":
            return f"{value!r}, expected one of {', '.join(map(str, expected))}{meaning}"
        case "minItems" | "minProperties":
            return f"{value!r}, expected at least {expected} {'entry' if expected == 1 else 'entries'}{meaning}"
        case "maxItems" | "maxProperties" | "items":
            return f"{value!r} has too many entries{meaning}"
        case "uniqueItems":
            return f"{value!r}, expected each entry once"
        case "oneOf" if meaning:
            return f"{value!r}, expected {error.schema['description']}"
        case "pattern" if expected == r"\S":
            return f"{value!r}, expected some text{meaning}"
        case "pattern":
            return f"{value!r}, expected a name of letters, digits and underscores"
        case "ascending":
            return error.message + meaning
        case _:
            return f"{value!r} is not of the expected form{meaning}"


def _is_number(text: str) -> bool:
    try:
        float(text)
    except ValueError:
        return False
    return True


def _plain(value: float) -> int | float:
    """A number as one would write it."""
    return int(value) if value.is_integer() else value


def _filled(value, schema: Mapping, root: Mapping):
    if "$ref" in schema:
        referred = root
        for key in schema["$ref"].removeprefix("#/").split("/"):
            referred = referred[key]
        schema = {**referred, **schema}
    if isinstance(value, dict):
        parts = schema.get("properties", {})
        filled = {key: part["default"] for key, part in parts.items() if "default" in part} | value
        ordered = [key for key in parts if key in filled] + [key for key in filled if key not in parts]
        value = {key: _filled(copy.deepcopy(filled[key]), parts.get(key, {}), root) for key in ordered}
    if isinstance(value, float) and "integer" in (kinds := schema.get("type", ())) and "number" not in kinds:
        value = int(value)
    if isinstance(value, list) and isinstance(schema.get("items"), Mapping):
        value = [_filled(entry, schema["items"], root) for entry in value]
    return value
