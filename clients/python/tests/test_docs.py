"""Examples in docstrings and in the README."""

import doctest
import inspect
import re
from pathlib import Path

import microfacet
from microfacet import exact


def test_examples_of_docstrings():
    for module in [microfacet, exact]:
        result = doctest.testmod(module)
        assert result.attempted > 0 and result.failed == 0


def test_examples_of_the_readme(tmp_path, monkeypatch):
    text = (Path(__file__).parents[1] / "README.md").read_text()
    blocks = re.findall(r"```python\n(.*?)```", text, re.S)
    # Those of Mitsuba are in docs/mitsuba.md, and its tests.
    blocks = [block for block in blocks if "mitsuba" not in block]
    assert len(blocks) >= 3
    monkeypatch.chdir(tmp_path)
    names: dict[str, object] = {}
    for block in blocks:
        exec(block, names)


def test_everything_is_documented():
    for name in microfacet.__all__:
        thing = getattr(microfacet, name)
        if name == "__version__":
            continue
        assert thing.__doc__, name
        if isinstance(thing, type):
            # Inherited members too: the base that lobes share has no public name.
            for member, value in inspect.getmembers(thing):
                if not member.startswith("_"):
                    assert value.__doc__, f"{name}.{member}"
