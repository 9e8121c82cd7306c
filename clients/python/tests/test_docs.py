"""Examples in docstrings, in the README and in the description of the package."""

import doctest
import inspect
import re
from pathlib import Path

import microfacet
import pytest
from microfacet import exact


def test_examples_of_docstrings():
    for module in [microfacet, exact]:
        result = doctest.testmod(module)
        assert result.attempted > 0 and result.failed == 0


def test_help_of_each_class_shows_an_example():
    for module in [microfacet, exact]:
        classes = [getattr(module, name) for name in module.__all__]
        classes = [thing for thing in classes if isinstance(thing, type)]
        assert classes
        tests = doctest.DocTestFinder(recurse=False)
        for thing in classes:
            (found,) = tests.find(thing)
            assert found.examples, thing
            # Else `test_examples_of_docstrings` does not find it.
            assert thing.__module__ == module.__name__, thing


@pytest.mark.parametrize("page", ["README.md", "DESCRIPTION.md"])
def test_examples_of_pages(page, tmp_path, monkeypatch):
    text = (Path(__file__).parents[1] / page).read_text()
    blocks = re.findall(r"```python\n(.*?)```", text, re.S)
    # Those of Mitsuba are in docs/mitsuba.md, and its tests.
    blocks = [block for block in blocks if "mitsuba" not in block]
    assert len(blocks) >= {"README.md": 3, "DESCRIPTION.md": 1}[page]
    monkeypatch.chdir(tmp_path)
    names: dict[str, object] = {"__name__": "__main__"}
    for block in blocks:
        exec(block, names)


@pytest.mark.parametrize(("section", "module"), [("PyTorch", "torch"), ("JAX", "jax")])
def test_examples_of_frameworks(section, module):
    pytest.importorskip(module)
    text = (Path(__file__).parents[3] / "docs" / "frameworks.md").read_text()
    (part,) = re.findall(rf"^## {section}\n(.*?)^## ", text, re.S | re.M)
    blocks = re.findall(r"```python\n(.*?)```", part, re.S)
    assert blocks
    names: dict[str, object] = {}
    for block in blocks:
        exec(block, names)
    if section == "PyTorch":
        found = [names[name].item() for name in ("sigma", "gamma", "rough")]
        assert found == [pytest.approx(0.3, 1e-6), pytest.approx(2.5, 1e-6), pytest.approx(0.3, 0.01)]


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
