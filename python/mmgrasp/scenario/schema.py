"""Values held against a JSON Schema, with messages that name the value: the words that the shipped schemas use."""

from __future__ import annotations

import math
import re
from typing import Any

from ..documents.reading import Node

_TYPES: dict[str, tuple[type, ...]] = {
    "object": (dict,),
    "array": (list,),
    "string": (str,),
    "boolean": (bool,),
    "integer": (int,),
    "number": (int, float),
    "null": (type(None),),
}
WORDS = {
    *("$ref", "type", "const", "enum", "oneOf", "properties", "required", "additionalProperties", "patternProperties"),
    *("dependentRequired", "items", "minItems", "maxItems", "minimum", "maximum", "exclusiveMinimum"),
    *("minLength", "pattern"),
}
NOTES = {"$schema", "$defs", "title", "description"}


def check_schema(node: Node, schema: dict[str, Any]) -> None:
    """Raises InvalidInput at the first value that the schema does not allow; numbers must be finite."""
    _Checker(schema.get("$defs", {})).check(node, schema)


class _Checker:
    def __init__(self, definitions: dict[str, Any]) -> None:
        self.definitions = definitions

    def resolve(self, schema: dict[str, Any]) -> dict[str, Any]:
        while "$ref" in schema:
            schema = self.definitions[schema["$ref"].removeprefix("#/$defs/")]
        return schema

    def check(self, node: Node, schema: dict[str, Any]) -> None:
        schema = self.resolve(schema)
        if "oneOf" in schema:
            schema = self.branch(node, [self.resolve(option) for option in schema["oneOf"]])
        rule = _broken(node.raw, schema)
        if rule:
            node.fail(rule)
        if isinstance(node.raw, dict):
            self.check_object(node, schema)
        elif isinstance(node.raw, list) and "items" in schema:
            items = self.resolve(schema["items"])
            simple = items.get("type") in ("number", "integer", "string", "boolean")
            for i, value in enumerate(node.raw):
                if not simple:
                    self.check(node.child(i), items)
                elif rule := _broken(value, items):
                    node.child(i).fail(rule)

    def branch(self, node: Node, options: list[dict[str, Any]]) -> dict[str, Any]:
        """The one whose `type` is the value's: every choice in the schemas is made by that key."""
        kind = node["type"].raw
        known: dict[str, dict[str, Any]] = {}
        for option in options:
            word = option["properties"]["type"]
            known |= dict.fromkeys(word.get("enum", [word.get("const")]), option)
        if not isinstance(kind, str) or kind not in known:
            node["type"].fail("must be one of " + ", ".join(known))
        return known[kind]

    def check_object(self, node: Node, schema: dict[str, Any]) -> None:
        properties = schema.get("properties", {})
        patterns = schema.get("patternProperties", {})
        for key in schema.get("required", []):
            node[key]  # fails when it is missing
        for key, others in schema.get("dependentRequired", {}).items():
            for other in others if key in node else []:
                node[other]
        for key, child in node.items():
            found = properties.get(key) or next((s for p, s in patterns.items() if re.search(p, key)), None)
            found = found or schema.get("additionalProperties", True)
            if found is False:
                child.refuse_key(list(properties))
            if isinstance(found, dict):
                self.check(child, found)


def _broken(value: Any, schema: dict[str, Any]) -> str:
    """The rule that a value by itself breaks; empty: none."""
    if "const" in schema and (value != schema["const"] or type(value) is not type(schema["const"])):
        return f"must be {schema['const']!r}"
    if "enum" in schema and value not in schema["enum"]:
        return "must be one of " + ", ".join(map(str, schema["enum"]))
    kinds = schema.get("type", [])
    kinds = [kinds] if isinstance(kinds, str) else kinds
    if kinds and not any(_is_of(value, kind) for kind in kinds):
        return "must be " + " or ".join(map(with_article, kinds))
    if isinstance(value, str):
        if len(value) < schema.get("minLength", 0):
            return "must be a text that is not empty"
        if "pattern" in schema and not re.search(schema["pattern"], value):
            return f"must match {schema['pattern']}"
    elif isinstance(value, list):
        if not schema.get("minItems", 0) <= len(value) <= schema.get("maxItems", math.inf):
            return f"must hold {_count(schema)} values"
    elif isinstance(value, int | float) and not isinstance(value, bool):
        return _out_of_range(value, schema)
    return ""


def _is_of(value: Any, kind: str) -> bool:
    return isinstance(value, _TYPES[kind]) and (not isinstance(value, bool) or kind == "boolean")


def with_article(kind: str) -> str:
    """A word behind its article."""
    return kind if kind == "null" else f"{'an' if kind[0] in 'aio' else 'a'} {kind}"


def _out_of_range(value: float, schema: dict[str, Any]) -> str:
    if isinstance(value, float) and not math.isfinite(value):
        return "must be finite"
    if "minimum" in schema and value < schema["minimum"]:
        return f"must be >= {schema['minimum']:g}"
    if "maximum" in schema and value > schema["maximum"]:
        return f"must be <= {schema['maximum']:g}"
    if "exclusiveMinimum" in schema and value <= schema["exclusiveMinimum"]:
        return f"must be > {schema['exclusiveMinimum']:g}"
    return ""


def _count(schema: dict[str, Any]) -> str:
    low, high = schema.get("minItems", 0), schema.get("maxItems")
    return str(low) if low == high else f"at least {low}" if high is None else f"from {low} to {high}"
