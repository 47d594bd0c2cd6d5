"""The JSON Schema of the config: for editors (config/schema.json) and error messages."""

import json
from collections.abc import Iterable
from functools import cache

from pydantic.json_schema import GenerateJsonSchema

from conveyor_pipeline.config.model import MODEL


class EditorSchema(GenerateJsonSchema):
    """A schema for overlays: no key is required, and keys have no titles made from their names."""

    def field_is_required(self, field, total):
        return False

    def field_title_should_be_set(self, schema):
        return False

    def float_schema(self, schema):
        # A number, or a text with a unit.
        return super().float_schema(schema) | {"type": ["number", "string"], "pattern": r"^\s*[-+.\d]"}

    def dict_schema(self, schema):
        made = super().dict_schema(schema)
        return made | {"additionalProperties": False} if "patternProperties" in made else made


@cache
def full_schema() -> dict:
    return {"$schema": EditorSchema.schema_dialect} | MODEL.json_schema(schema_generator=EditorSchema)


def json_schema() -> str:
    """The text of config/schema.json."""
    return json.dumps(full_schema(), ensure_ascii=False, indent=1) + "\n"


def options_of(schema: dict) -> list[dict]:
    """The alternatives of a part of the schema, with references to shared definitions replaced."""
    if "$ref" in schema:
        schema = full_schema()["$defs"][schema["$ref"].rpartition("/")[2]] | schema
    options = schema.get("oneOf") or schema.get("anyOf")
    return [inner for option in options for inner in options_of(option)] if options else [schema]


def child(schema: dict, part: str | int) -> dict:
    """The schema of a key or of a list item; {} if there is no such key."""
    for option in options_of(schema):
        if isinstance(part, int) and option.get("type") == "array":
            return option["prefixItems"][part] if "prefixItems" in option else option["items"]
        if isinstance(part, str) and option.get("type") == "object":
            of_any_name = [*option.get("patternProperties", {}).values(), option.get("additionalProperties") or {}]
            return option.get("properties", {}).get(part) or of_any_name[0]
    return {}


def schema_at(path: Iterable[str | int]) -> dict:
    """The schema of the value at a path."""
    schema = full_schema()
    for part in path:
        schema = child(schema, part)
    return schema


def unit_of(schema: dict) -> str:
    return next((option["unit"] for option in options_of(schema) if "unit" in option), "")
