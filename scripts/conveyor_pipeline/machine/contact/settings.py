"""Settings of the stage contact: stiffness and damping from materials and from a drop. No slow imports."""

from typing import Any, NotRequired

from typing_extensions import TypedDict

from conveyor.materials import ELASTOMERS, LARGEST_RADIUS, SOFTEST, STIFFEST, materials
from conveyor_pipeline.common.settings import described, mapping, number, text, union
from conveyor_pipeline.machine.contact.derive import contact_of
from conveyor_pipeline.machine.operating.settings import blocks_settings


def material_form(value: Any) -> str | None:
    return "moduli" if isinstance(value, dict) else "name" if isinstance(value, str) else None


SHORE = r"(([2-8]\d|9[0-5])A|([3-6]\d|7[0-5])D)"  # the hardnesses of `conveyor.materials.HARDNESS`
NAMES = f"one of {', '.join(materials())}, or an elastomer of 20A to 95A or 30D to 75D, such as {ELASTOMERS[1]}_85A"
MATERIAL = union(
    "a material, or its moduli",
    "the name of a material, or {modulus: …, poisson: …}",
    material_form,
    name=text("name of a material", rf"({'|'.join(materials())}|({'|'.join(ELASTOMERS)})_{SHORE})", NAMES),
    moduli=mapping(
        "elastic constants",
        {
            "modulus": number("Young's modulus", "Pa", ge=SOFTEST, le=STIFFEST),
            "poisson": number("Poisson's ratio", gt=-1, le=0.5),
        },
    ),
)


class Contact(TypedDict):
    part: NotRequired[described(MATERIAL | None, "material of the part; null: none")]
    lining: NotRequired[described(MATERIAL | None, "material of the lining; null: none")]
    radius: NotRequired[
        described(
            number("radius", "m", gt=0, le=LARGEST_RADIUS) | None,
            "radius of the part at the place of contact; null: none",
        )
    ]
    restitution: NotRequired[
        described(
            number("restitution", gt=0, le=1) | None,
            "coefficient of restitution in a drop on the plate at rest, √(height after / height before); null: none",
        )
    ]
    drop_height: number("height of this drop", "m", ge=1e-6, le=1)


SECTIONS = {"contact": described(Contact, "the contact from materials and from a drop")}


def variants_settings(config: dict) -> dict:
    """The parts of the transit table, and the section `contact`."""
    transit = {name: value for name, value in blocks_settings(config).items() if name != "acceleration"}
    return {**transit, "contact": config["contact"]}


# Sections from which parameters of the model follow, and the function that returns these.
DERIVED = {"contact": contact_of}
TABLE_SETTINGS = {"contact/variants": variants_settings}
