"""The JSON Schema of the config: for editors (config/schema.json), error messages, and scaling."""

import json
from functools import cache
from typing import Any

from .model import MODEL


@cache
def full_schema() -> dict:
    return MODEL.json_schema()


def resolve_reference(schema: dict) -> dict:
    """A part of the schema with its reference to a shared definition replaced by this definition."""
    if "$ref" not in schema:
        return schema
    return full_schema()["$defs"][schema["$ref"].rpartition("/")[2]] | {k: v for k, v in schema.items() if k != "$ref"}


def options_of(schema: dict) -> list[dict]:
    """The alternatives of a part of the schema, itself if there is one only."""
    schema = resolve_reference(schema)
    return [resolve_reference(option) for option in schema.get("oneOf") or schema.get("anyOf") or [schema]]


def child(schema: dict, part: str | int) -> dict:
    """The schema of a key or of a list item; {} if there is no such key."""
    for option in options_of(schema):
        if isinstance(part, int) and option.get("type") == "array":
            return resolve_reference(option["prefixItems"][part] if "prefixItems" in option else option["items"])
        if isinstance(part, str) and option.get("type") == "object":
            of_any_name = [*option.get("patternProperties", {}).values(), option.get("additionalProperties") or {}]
            return resolve_reference(option.get("properties", {}).get(part) or of_any_name[0])
    return {}


def schema_at(path: list[str | int]) -> dict:
    """The schema of the value at a path."""
    schema = full_schema()
    for part in path:
        schema = child(schema, part)
    return schema


def unit_of(schema: dict) -> str:
    return next((option["unit"] for option in options_of(schema) if "unit" in option), "")


def published(schema: Any) -> Any:
    """The schema without required keys, which overlays need not have, and without generated titles."""
    if isinstance(schema, list):
        return [published(item) for item in schema]
    if not isinstance(schema, dict):
        return schema
    dropped = {name for name in ("required", "title") if not isinstance(schema.get(name), dict)}
    closed = {"additionalProperties": False} if "patternProperties" in schema else {}
    return {name: published(item) for name, item in schema.items() if name not in dropped} | closed


def json_schema() -> str:
    """The text of config/schema.json."""
    schema = {"$schema": "https://json-schema.org/draft/2020-12/schema"} | published(full_schema())
    return json.dumps(schema, ensure_ascii=False, indent=1) + "\n"
