"""The part of lagroid/_lagroid.pyi that follows from the systems of the program: a class each, its keywords with types.

    stubs.py          write it (`./lagroid pages stubs`)

Names, units, meanings and words are those that systems declare (core/parameter.hpp), as lagroid.systems() lists them;
what a class has beside them is looked up in the module."""

import re
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import lagroid
import numpy as np
from lagroid import _lagroid

STUB = Path(__file__).parents[1] / "lagroid" / "_lagroid.pyi"
BEGIN, END = "# Systems: written by ./lagroid pages stubs\n", "# End of what is written.\n"


def listed_as(name: str) -> dict[str, Any]:
    """What the program lists of the system of this class: PlateBall is plate_ball."""
    return lagroid.systems()[re.sub(r"(?<=.)(?=[A-Z])", "_", name).lower()]


def words_of(parameter: dict[str, str]) -> list[str]:
    """Those of "meaning: one, another or a third"."""
    return re.split(r", | or ", parameter["meaning"].rpartition(": ")[2])


def annotation(value: Any, parameter: dict[str, str]) -> str:
    """The type of the keyword that takes such values; arrays are given as anything that becomes one."""
    if isinstance(value, str):
        return f"Literal[{', '.join(f'{word!r}' for word in words_of(parameter))}]".replace("'", '"')
    return "ArrayLike" if isinstance(value, np.ndarray) else "float"


def meaning(parameter: dict[str, str]) -> str:
    """In words, for a comment."""
    text = parameter["meaning"].partition(": ")[0]
    return text if parameter["unit"] in ("", "1") else f"{text}, {parameter['unit']}"


def class_stub(made: type) -> Iterator[str]:
    """The lines of one class."""
    parameters = listed_as(made.__name__)["parameters"]
    system = made()
    types = {each["name"]: annotation(getattr(system, each["name"]), each) for each in parameters}
    base = "_WithBoundary" if hasattr(made, "boundary") else "_System"
    yield f"class {made.__name__}({base}):"
    yield "    def __init__("
    yield "        self,"
    yield "        *,"
    yield "        h: float = ...,"
    for each in parameters:
        yield f"        {each['name']}: {types[each['name']]} = ...,  # {meaning(each)}"
    yield "    ) -> None: ..."
    for name, type_of_it in types.items():
        if type_of_it == "ArrayLike":
            yield "    @property"
            yield f"    def {name}(self) -> _Array: ..."
            yield f"    @{name}.setter"
            yield f"    def {name}(self, value: ArrayLike) -> None: ..."
        else:
            yield f"    {name}: {type_of_it}"
    for name, member in vars(made).items():
        if isinstance(member, staticmethod):
            arrays = re.findall(r"(\w+): numpy\.ndarray", (getattr(made, name).__doc__ or "").partition(" -> ")[0])
            yield "    @staticmethod"
            yield f"    def {name}({', '.join(f'{each}: ArrayLike' for each in arrays)}) -> _Array: ..."


def systems_stub() -> str:
    """All of them, and their names."""
    names = list(_lagroid.__all__)
    lines = ["__all__ = [", *(f'    "{name}",' for name in names), "]", ""]
    for name in names:
        lines += [*class_stub(getattr(_lagroid, name)), ""]
    return "\n".join(lines)


def with_systems(stub: str) -> str:
    """The stub with this part written anew."""
    before, rest = stub.split(BEGIN)
    _, after = rest.split(END)
    return f"{before}{BEGIN}\n{systems_stub()}\n{END}{after}"


if __name__ == "__main__":
    STUB.write_text(with_systems(STUB.read_text()))
