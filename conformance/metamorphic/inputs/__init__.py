"""Changes of inputs whose effect on the result is known. The functions are data: relations.toml."""

from conformance.metamorphic.inputs.load import load_relations
from conformance.metamorphic.relation import InputRelation

RELATIONS: tuple[InputRelation, ...] = load_relations()
